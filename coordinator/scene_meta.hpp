#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/fields.hpp"

namespace abut {

/// One statement about the run's result; exactly one of equals, at_most, at_least is given.
struct Expectation {
  std::string measure;
  std::optional<double> equals, at_most, at_least;
  std::optional<double> relative, absolute;  // tolerance of equals: exactly one
  std::string because;
  void fields(Fields& f);
};

/// Closed form of two free uniform bars that hit head-on, or of one bar on a rigid wall.
struct BarImpactForm {
  static constexpr std::string_view name = "bar_impact";
  std::string interface;
  void fields(Fields& f);
};

/// Closed form of all bodies of the scene: uniform bars and rigid walls that meet in a row.
struct BarsForm {
  static constexpr std::string_view name = "bars";
  void fields(Fields&) {}
};

struct Meta {
  std::string title;
  std::optional<std::variant<BarImpactForm, BarsForm>> closed_form;
  std::vector<Expectation> expect;
  void fields(Fields& f);
};

}  // namespace abut
