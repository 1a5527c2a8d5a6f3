#pragma once

#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"

// Bodies in their passive form, for tests that loop over kinds of them.

namespace abut {

/// A block of side 1 per direction with a port on its right side.
struct PassiveText {
  int dim = 2;
  std::string element = "quad4";
  int cells = 3;
  std::string scheme = "newmark: {step: 0.01}";
  std::string law = "linear_elastic";
  bool touched = true;  // a surface of the layer, where there may be one
  std::string more = {};
  std::string model = "fe", keys = {};
  std::string material = {};

  std::string label() const {
    return fmt::format("{}D {} {} {} {} {}", dim, model + keys, element, scheme, law,
                       touched ? "layer" : "plain");
  }
  std::unique_ptr<Subdomain> build() const {
    const std::vector<double> lengths(index(dim), 1.0);
    const std::vector<int> counts(index(dim), cells);
    const std::string law_text =
        material.empty()
            ? fmt::format("{}: {{youngs_modulus: 100.0, poissons_ratio: 0.3, density: 2.0}}", law)
            : material;
    const std::string text = fmt::format(
        "bodies: {{it: {{model: {{{}: {{dimension: {}, {}mesh: {{{}}}}}}}, material: {{{}}}, "
        "integrator: {{{}}}, ports: {{face: {{side: right}}}}{}{}}}}}",
        model, dim, keys, block_mesh(lengths, counts, element), law_text, scheme,
        more.empty() ? "" : ", ", more);
    BodyContext context;
    if (touched) context.ports.push_back({.port = "face", .touches = true, .partners = {}});
    return make_body(Document::from_text("test", text), "bodies.it", context);
  }
};

/// A body in its passive form, and its time.
class PassiveRun {
 public:
  explicit PassiveRun(std::unique_ptr<Subdomain> body) : own_(std::move(body)), body_(own_.get()) {
    EXPECT_TRUE(body_->describe().can.passive);
    lost = body_->passive()->enter();
  }
  /// Of a body that is in its passive form, at a time.
  PassiveRun(std::nullptr_t, Subdomain& body, double now) : time(now), body_(&body) {}

  Subdomain& body() { return *body_; }
  std::size_t values() const { return body_->describe().ports[0].geometry.points.size(); }
  std::size_t dim() const { return index(body_->describe().dim); }

  Outcome attempt(double length, const std::vector<double>& impulses,
                  const std::vector<std::int32_t>& pressed, PassiveReply& reply,
                  std::int32_t looser = 0) {
    PassiveStep request;
    request.looser = looser;
    request.again = again;
    request.begin = time;
    request.end = time + length;
    request.impulses = {impulses};
    request.pressed = {pressed};
    body_->passive()->start(request);
    return body_->passive()->finish(reply);
  }
  /// Under impulses (values) on the port; empty: none.
  PassiveReply step(double length, const std::vector<double>& impulses = {},
                    const std::vector<std::int32_t>& pressed = {}, std::int32_t looser = 0) {
    PassiveReply reply;
    const Outcome outcome = attempt(length, impulses, pressed, reply, looser);
    if (const Failed* failed = std::get_if<Failed>(&outcome))
      throw std::runtime_error(failed->detail);
    time += length;
    return reply;
  }
  std::vector<double> random_impulses(double size) {
    std::vector<double> out(values());
    std::uniform_real_distribution<double> draw(-size, size);
    for (double& impulse : out) impulse = draw(engine_);
    return out;
  }

  double time = 0.0, lost = 0.0;
  bool again = false;  // what follows is the last step once more

 private:
  std::unique_ptr<Subdomain> own_;
  Subdomain* body_;
  std::mt19937_64 engine_{11};
};

/// [J] that impulses did over a step.
inline double work_of(const std::vector<double>& impulses, const PassiveReply& reply,
                      double length) {
  double sum = 0.0;
  for (std::size_t k = 0; k < impulses.size(); ++k)
    sum += impulses[k] * reply.ports[0].displacement[k] / length;
  return sum;
}

inline std::vector<double> sum_of(const std::vector<double>& values, std::size_t dim) {
  std::vector<double> out(dim, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) out[k % dim] += values[k];
  return out;
}

/// Elements of the plane and of space, and the dimension of each.
inline std::vector<PassiveText> every_element() {
  std::vector<PassiveText> all;
  for (const char* element : {"tri3", "tri6", "quad4", "quad8"}) all.push_back({2, element});
  for (const char* element : {"tet4", "tet10", "hex8", "hex20"}) all.push_back({3, element, 2});
  return all;
}

}  // namespace abut
