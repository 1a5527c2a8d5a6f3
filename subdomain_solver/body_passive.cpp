// The passive form of a body, as others see it.

#include <chrono>
#include <utility>

#include "base/assert.hpp"
#include "subdomain_solver/body.hpp"
#include "subdomain_solver/passive/passive_body.hpp"

namespace abut {

PassiveForm* Body::passive() { return interior_->able().passive != nullptr ? &passive_ : nullptr; }

double Body::Passive::enter() { return body_.interior_->able().passive->enter(); }

Outcome Body::Passive::leave(double time, double& lost) {
  PassiveBody& own = *body_.interior_->able().passive;
  if (auto failed = body_.patiently([&] { return own.leave(time, lost); })) return *failed;
  return Advanced{};
}

Outcome Body::Passive::finish(PassiveReply& reply) {
  ABUT_ASSERT(step_ != nullptr);
  const PassiveStep& step = *std::exchange(step_, nullptr);
  PassiveBody& own = *body_.interior_->able().passive;
  const auto began = std::chrono::steady_clock::now();
  body_.report_progress();  // a window may have thousands of steps, many of them without an answer
  if (auto failed = body_.patiently([&] { return own.pass(step, reply); })) return *failed;
  if (auto failed = body_.tell(reply.record, step.end)) return *failed;
  reply.compute_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return Advanced{};
}

double Body::Passive::damp(double joules) { return body_.interior_->able().passive->damp(joules); }

}  // namespace abut
