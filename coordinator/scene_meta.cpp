#include "coordinator/scene_meta.hpp"

#include <fmt/format.h>

namespace abut {

void Expectation::fields(Fields& f) {
  f.required("measure", measure, "", "name of the measure in summary.json");
  f.optional("equals", equals, "", "expected value");
  f.optional("at_most", at_most, "", "upper bound");
  f.optional("at_least", at_least, "", "lower bound");
  f.optional("relative", relative, "", "tolerance of equals as a fraction of it", non_negative);
  f.optional("absolute", absolute, "", "tolerance of equals in the measure's unit", non_negative);
  f.required("because", because, "", "reason for the value and the tolerance");
  const int bounds = int(equals.has_value()) + int(at_most.has_value()) + int(at_least.has_value());
  const int tolerances = int(relative.has_value()) + int(absolute.has_value());
  f.check(bounds == 1, "measure", fmt::format("has {} expected values", bounds),
          "Give exactly one of equals, at_most, at_least beside it.");
  f.check(tolerances == (equals ? 1 : 0), "measure", fmt::format("has {} tolerances", tolerances),
          "Give exactly one of relative, absolute beside equals, and none beside a bound.");
}

void BarImpactForm::fields(Fields& f) {
  f.required("interface", interface, "", "name of the interface at which the bars meet");
}

void Meta::fields(Fields& f) {
  f.optional("title", title, "",
             "sentence that says what the scene shows; usual: the name of its file");
  f.choice("closed_form", closed_form, "exact solution to compare with");
  f.list("expect", expect, "statements about the result, evaluated after the run");
}

}  // namespace abut
