#pragma once

#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/support/scenes.hpp"

namespace abut {

/// One way to advance a bar, and where it is touched.
struct SolverCase {
  std::string name;
  std::string integrator, layer;
  std::vector<std::string> sides;

  friend std::ostream& operator<<(std::ostream& out, const SolverCase& c) { return out << c.name; }
};

constexpr int case_elements = 40;
/// h / c of the cases' bar is 1 s.
constexpr double case_step = 0.6;

/// The cases' bar: length 40 m, wave speed and impedance 1, at rest unless told otherwise.
inline BarText case_bar(const SolverCase& c, double velocity = 0.0) {
  BarText bar = unit_bar("bar", case_elements, case_elements, c.integrator, 0.0, velocity);
  bar.layer = c.layer;
  bar.sides = c.sides;
  return bar;
}

/// Every integrator with every contact layer that it offers for complete reactions, at each side
/// and at both.
inline std::vector<SolverCase> complete_cases(double step = case_step) {
  std::vector<SolverCase> cases;
  const std::vector<std::vector<std::string>> places = {{"left"}, {"right"}, {"left", "right"}};
  auto add = [&cases, &places](const std::string& name, const std::string& integrator,
                               const std::string& layer) {
    for (const std::vector<std::string>& sides : places) {
      std::string label = name;
      for (const std::string& side : sides) label += "_" + side;
      cases.push_back({label, integrator, layer, sides});
    }
  };
  for (int terms : {1, 2, 6, 12}) {
    const std::string p = "explicit" + std::to_string(terms);
    add(p + "_massless", explicit_scheme(step, terms), "massless: {stiffness_factor: 1.4}");
    add(p + "_kick", explicit_scheme(step, terms), "kick: {}");
  }
  for (const char* scheme : {"newmark", "hht_alpha", "generalized_alpha"})
    add(std::string(scheme) + "_massless", implicit_scheme(scheme, step), "massless: {}");
  return cases;
}

/// The same and the massive layer of the published form.
inline std::vector<SolverCase> all_cases(double step = case_step) {
  std::vector<SolverCase> cases = complete_cases(step);
  for (const char* side : {"left", "right"}) {
    cases.push_back(
        {std::string("explicit_massive_") + side, explicit_scheme(step), "massive: {}", {side}});
    cases.push_back({std::string("newmark_massive_") + side,
                     implicit_scheme("newmark", step),
                     "massive: {}",
                     {side}});
  }
  return cases;
}

inline std::string case_name(const testing::TestParamInfo<SolverCase>& info) {
  return info.param.name;
}

inline double outward(const Subdomain& body, std::size_t port) {
  return body.describe().ports[port].geometry.normals[0];
}

/// Times of a window's begin and of its substeps.
inline std::vector<double> substep_times(double begin, double end, double step) {
  std::vector<double> times;
  const int count = static_cast<int>(std::ceil((end - begin) / step - 1.0e-6));
  for (int i = 0; i < count; ++i) times.push_back(begin + i * step);
  times.push_back(end);
  return times;
}

/// A port of one point meets another one, `distance` outside it; tied, or in contact.
inline void meet_point(Subdomain& body, std::size_t port, bool tied, double distance = 0.0) {
  PortGeometry point = body.describe().ports[port].geometry;
  point.points[0] += distance * point.normals[0];
  point.normals[0] *= -1.0;
  body.meet({static_cast<int>(port), 0, &point, {.tied = tied}});
}

/// The kernel of a port of one point along its outward normal.
inline PortKernel normal_kernel(Subdomain& body, int port, double step, int count) {
  const std::vector<double> normal = body.describe().ports[port].geometry.normals;
  PortKernel kernel = body.probe({port, normal, step, count});
  for (std::vector<double>* values : {&kernel.compliance, &kernel.displacement, &kernel.begin})
    for (double& value : *values) value *= normal[0];
  return kernel;
}

/// A surface that starts where the port is and pushes it inwards, smoothly but not polynomially;
/// inward displacement of size `depth` at the end.
inline Obstacle pushing_surface(const Subdomain& body, std::size_t port,
                                const std::vector<double>& times, double depth) {
  Obstacle obstacle;
  const double length = times.back() - times.front();
  for (double t : times) {
    const double s = (t - times.front()) / length;
    obstacle.motion.time.push_back(t);
    obstacle.motion.u.push_back(-outward(body, port) * depth * s * s *
                                (1.0 + 0.3 * std::sin(9 * s)));
  }
  return obstacle;
}

/// Advances, or fails the test.
inline void step(Subdomain& body, const Advance& request, Response& response) {
  const Outcome outcome = body.advance(request, response);
  if (const Failed* failed = std::get_if<Failed>(&outcome)) FAIL() << failed->detail;
}

}  // namespace abut
