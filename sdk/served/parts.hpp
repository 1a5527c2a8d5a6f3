#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "contract/field.hpp"
#include "contract/port.hpp"

/// What a user's program has told of its body beside the numbers and functions of abut_body.
struct abut_parts {
  struct State {
    std::string name;
    double* values;
    std::size_t count;
  };

  std::vector<abut::Port> ports;
  std::vector<State> states;
  abut::Grid grid;  // empty: the surfaces of the ports
  std::vector<abut::FieldInfo> fields;
  std::optional<abut::InputError> wrong;  // the first thing; thrown when the body is complete

  void refuse(const std::string& what, const std::string& where, const std::string& remedy) {
    if (!wrong) wrong.emplace(what, where, remedy);
  }
};
