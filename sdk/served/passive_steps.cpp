#include "sdk/served/passive_steps.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr double rounding_of_count = 1.0e-6;  // of a step: less than this is no step of its own

}  // namespace

PassiveSteps::PassiveSteps(UserBody& body, const UserBody::State& initial,
                           const std::function<void()>& alive)
    : body_(body), initial_(initial), alive_(alive) {}

Outcome PassiveSteps::finish(PassiveReply& reply) {
  reply = PassiveReply{};
  reply.ports.resize(body_.ports().size());
  const std::vector<double> impulses = impulses_asked();
  if (std::optional<Failed> failed = find_compliance(impulses, reply.compliance)) return *failed;
  const bool goes = asked_->length() > 0.0;
  std::vector<double> from(body_.values(), 0.0);
  if (goes) {
    from = body_.displacement();
    if (std::optional<Failed> failed = walk(impulses)) return *failed;
  }
  place(reply, from);
  reply.record = body_.record(asked_->end);
  return Advanced{};
}

/// [N s] (values) on all points.
std::vector<double> PassiveSteps::impulses_asked() const {
  std::vector<double> all(body_.values(), 0.0);
  for (std::size_t p = 0; p < body_.ports().size(); ++p)
    std::ranges::copy(asked_->impulses[p],
                      all.begin() + static_cast<std::ptrdiff_t>(body_.first(p)));
  return all;
}

/// In steps of the body's own, under a force that is constant over all of them.
std::optional<Failed> PassiveSteps::walk(const std::vector<double>& impulses) {
  const double length = asked_->length(), nominal = body_.told().substep;
  const double count = nominal > 0.0 ? std::ceil(length / nominal - rounding_of_count) : 1.0;
  const int steps = std::max(1, static_cast<int>(count));
  std::vector<double> force = impulses;
  for (double& each : force) each /= length;
  for (int i = 0; i < steps; ++i) {
    if (const char* const why = body_.step(length / steps, force))
      return Failed{Failed::Cause::no_convergence, asked_->begin, why};
    alive_();
  }
  for (const double u : body_.displacement())
    if (!std::isfinite(u))
      return Failed{Failed::Cause::non_finite, asked_->end, "a displacement is no number"};
  return std::nullopt;
}

void PassiveSteps::place(PassiveReply& reply, const std::vector<double>& from) const {
  for (std::size_t p = 0; p < reply.ports.size(); ++p)
    for (std::size_t k = body_.first(p); k < body_.first(p + 1); ++k) {
      reply.ports[p].displacement.push_back(body_.displacement()[k] - from[k]);
      reply.ports[p].velocity.push_back(body_.velocity()[k]);
    }
}

/// [1/kg] (pressed values, pressed values): the differences of ways with and without an impulse
/// each, over the length squared; made symmetric, which it is to rounding where steps are linear.
std::optional<Failed> PassiveSteps::find_compliance(const std::vector<double>& impulses,
                                                    std::vector<double>& compliance) {
  std::vector<std::size_t> rows;
  const std::size_t dim = index(body_.told().dim);
  for (std::size_t p = 0; p < body_.ports().size(); ++p)
    for (const std::int32_t point : asked_->pressed[p])
      for (std::size_t i = 0; i < dim; ++i) rows.push_back(body_.first(p) + index(point) * dim + i);
  compliance.assign(rows.size() * rows.size(), 0.0);
  const double length = asked_->length();
  if (rows.empty() || !(length > 0.0) || std::isinf(body_.told().mass)) return std::nullopt;
  const bool linear = body_.told().linear != 0;
  if (linear && length == known_.length && asked_->pressed == known_.pressed) {
    compliance = known_.compliance;
    return std::nullopt;
  }
  const UserBody::State present = body_.snapshot();
  const std::vector<double> under = linear ? std::vector<double>(body_.values(), 0.0) : impulses;
  const double small = body_.told().mass;                // [N s] what makes 1 m/s of all of it ...
  const double pulse = linear ? small : 1.0e-6 * small;  // ... or of a body that bends, far less
  std::vector<double> free;
  const auto way = [&](const std::vector<double>& of) {
    body_.return_to(linear ? initial_ : present);
    return walk(of);
  };
  std::optional<Failed> failed = way(under);
  free = body_.displacement();
  for (std::size_t j = 0; j < rows.size() && !failed; ++j) {
    std::vector<double> pushed = under;
    pushed[rows[j]] += pulse;
    failed = way(pushed);
    for (std::size_t i = 0; i < rows.size() && !failed; ++i) {
      const double part = (body_.displacement()[rows[i]] - free[rows[i]]) / (pulse * length) / 2.0;
      compliance[i * rows.size() + j] += part;
      compliance[j * rows.size() + i] += part;
    }
  }
  body_.return_to(present);
  if (linear && !failed) known_ = {length, asked_->pressed, compliance};
  return failed;
}

}  // namespace abut
