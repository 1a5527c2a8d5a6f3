#pragma once

#include <string>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/split/split_body.hpp"

namespace abut {

/// Which keys a divided scene writes: those that the scene has, and those that the division makes.
/// What is left to its default stays so; written out, it would be refused as soon as another choice
/// leaves it without effect.
class SplitKeys {
 public:
  SplitKeys(const Document& document, const WholeBody& whole, const std::vector<std::string>& parts)
      : document_(document), whole_(whole), parts_(parts) {}

  bool wants(const std::string& path) const;

 private:
  bool wants_of_part(const std::vector<std::string>& steps) const;
  bool wants_of_interface(const std::vector<std::string>& steps) const;

  const Document& document_;
  const WholeBody& whole_;
  const std::vector<std::string>& parts_;  // names
};

}  // namespace abut
