#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/fields.hpp"

namespace abut {

// When a run or a stage begins and ends.

struct UntilContact {  // a contact begins
  static constexpr std::string_view name = "contact";
  static constexpr std::string_view shorthand = "interface";
  std::string interface;
  void fields(Fields& f);
};
struct UntilApart {  // one has ended
  static constexpr std::string_view name = "apart";
  static constexpr std::string_view shorthand = "interface";
  std::string interface;
  void fields(Fields& f);
};

struct TimeSpec {
  double begin = 0.0, end = 0.0, window = 0.0;                 // [s]
  std::optional<std::variant<UntilContact, UntilApart>> until;  // ends before `end`
  void fields(Fields& f);
};

}  // namespace abut
