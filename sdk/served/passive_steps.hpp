#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "contract/passive.hpp"
#include "sdk/served/user_body.hpp"

namespace abut {

/// The passive form of a user's body: its own steps, under forces that are constant over a passive
/// step, so that work is impulse times way over the step's length, as of the midpoint rule. How
/// points give way is found by trying. All of its mass is on nodes already: to enter and to leave
/// change nothing.
class PassiveSteps final : public PassiveForm {
 public:
  /// `initial`: from where a linear body is tried.
  PassiveSteps(UserBody& body, const UserBody::State& initial, const std::function<void()>& alive);

  double enter() override { return 0.0; }
  [[nodiscard]] Outcome leave(double, double& lost) override {
    lost = 0.0;
    return Advanced{};
  }
  void start(const PassiveStep& step) override { asked_ = &step; }
  [[nodiscard]] Outcome finish(PassiveReply& reply) override;
  /// What of its velocities deforms it is not known: nothing is taken.
  double damp(double) override { return 0.0; }

 private:
  std::optional<Failed> walk(const std::vector<double>& impulses);
  std::optional<Failed> find_compliance(const std::vector<double>& impulses,
                                        std::vector<double>& compliance);
  std::vector<double> impulses_asked() const;
  void place(PassiveReply& reply, const std::vector<double>& from) const;

  UserBody& body_;
  const UserBody::State& initial_;
  const std::function<void()>& alive_;
  const PassiveStep* asked_ = nullptr;
  struct Known {
    double length = 0.0;                             // [s]
    std::vector<std::vector<std::int32_t>> pressed;  // as in the request
    std::vector<double> compliance;                  // [1/kg]
  } known_;  // of a linear body, whose state does not matter: the last one found
};

}  // namespace abut
