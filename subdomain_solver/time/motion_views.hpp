#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/index.hpp"
#include "contract/outcome.hpp"
#include "subdomain_solver/model.hpp"
#include "subdomain_solver/solve/newton.hpp"
#include "subdomain_solver/time/contact.hpp"

namespace abut {

// Between the lists of a motion and Eigen's vectors.

inline Eigen::Map<const Vector> view(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}
inline Eigen::Map<Vector> view(std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}
inline std::span<const double> span_of(const Vector& values) {
  return {values.data(), index(values.size())};
}
inline void store(const Vector& from, std::vector<double>& to) {
  to.assign(from.data(), from.data() + from.size());
}

/// A time at which something has no value, for people.
inline Failed not_finite(double time) {
  return {Failed::Cause::non_finite, time,
          "a force or a motion is not finite: look at the expressions of loads and constraints "
          "at this time, then at the step"};
}

/// A Newton solve without an answer, for people. `contact`: that took part; null: none did.
inline Failed failed_newton(const NewtonReport& report, double time,
                            const Contact* contact = nullptr) {
  using End = NewtonReport::End;
  if (report.end == End::singular && contact != nullptr && !contact->missing().empty())
    return {Failed::Cause::no_convergence, time, contact->missing()};
  switch (report.end) {
    case End::inadmissible:
      return {Failed::Cause::inverted_element, time,
              "an element is inverted, or its material has no answer: take a smaller step or a "
              "finer mesh there"};
    case End::singular:
      return {Failed::Cause::no_convergence, time,
              "the tangent is singular: the body may lack a support, or it buckles"};
    default:
      if (!std::isfinite(report.residual)) return not_finite(time);
      return {Failed::Cause::no_convergence, time,
              fmt::format("Newton's method has not converged after {} iterations, relative "
                          "residual {:.2g}: take a smaller step",
                          report.iterations, report.residual)};
  }
}

}  // namespace abut
