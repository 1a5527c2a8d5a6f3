#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/passive/passive_body.hpp"
#include "subdomain_solver/rigid/tool_turn.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

/// A rigid shape in two or three dimensions on a given way: a wall where it stands, a die, a punch;
/// where it turns, a roller, a paddle, a screw. Takes any force and goes where it is told; its
/// energy and momentum are nobody's.
class RigidTool final : public Interior, private PassiveBody {
 public:
  /// Displacement [m] along an axis, of time [s].
  using Way = std::function<double(double)>;
  /// `way`: one per dimension. `turn`: absent, it does not. `step`: [s] by which its way is told;
  /// 0: of windows.
  RigidTool(std::string name, std::unique_ptr<FeModel> shape, std::vector<Way> way,
            std::optional<ToolTurn> turn, double step,
            const std::vector<SolidInterior::PortNodes>& ports, const std::string& words);

  void state(Archive& archive) override;
  std::size_t coordinates() const override { return way_.size(); }
  std::optional<Failed> begin(const Window& window) override;
  std::optional<Failed> step(const Window& window, int i, bool whole) override;
  const PortValues& see(const Window& window, double time, bool all) override;
  std::optional<Failed> record(BodyRecord& record) override;
  void finish(std::size_t port, PortResponse& reply) const override;
  std::vector<double> measure() override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

 private:
  // Nothing it has is other in its passive form.
  double enter() override;
  std::optional<Failed> leave(double, double& lost) override;
  double damp(double) override { return 0.0; }
  std::optional<Failed> pass(const PassiveStep& step, PassiveReply& reply) override;

  /// Forces or impulses of partners together.
  struct Load {
    std::vector<double> force;  // [N] (dim)
    // [N m] of a tool that turns: forces times the arms of their points before it turns, summed
    Eigen::Matrix3d on_arms = Eigen::Matrix3d::Zero();
  };
  Load no_load() const { return {std::vector<double>(way_.size(), 0.0)}; }
  void add(double force, std::size_t value, Load& to) const;

  std::optional<Failed> go_to(double time, const Load& mean);
  std::optional<Failed> turn_to(double time, const Load& mean);
  void mean_force(const Window& window, double time, Load& mean);
  std::optional<Failed> move_to(const Window& window, double time);
  Eigen::Matrix3d turned() const { return turn_->between(0.0, state_.angle); }
  Eigen::Matrix3d turning() const;
  double moment(const Load& load) const;
  double fastest(std::size_t port) const;

  struct State {
    double time = 0.0;             // [s]
    std::vector<double> place;     // [m] (dim) now
    std::vector<double> force;     // [N] (dim) of all partners now
    double work = 0.0;             // [J] that it has done on them
    std::vector<double> velocity;  // [m/s] (dim) over the last step
    // Of a tool that turns:
    double angle = 0.0, before = 0.0;  // [rad] now, and where the last step began
    double length = 0.0;               // [s] of the last step
    double moment = 0.0;               // [N m] of all partners about the axis now
  };

  std::unique_ptr<FeModel> shape_;
  std::vector<Way> way_;
  std::optional<ToolTurn> turn_;
  std::vector<Eigen::Vector3d> arms_;  // [m] of the ports' points, before a tool that turns does
  std::vector<std::size_t> first_;     // (ports) of their points among these
  double farthest_ = 0.0;              // [m] the longest of the arms
  State state_;
  PortValues seen_;
  std::vector<double> shown_place_, shown_velocity_;  // that seen_ tells of
  std::array<double, 3> shown_turn_{};                // the same: angles and length
  bool pushed_ = false;                               // there are forces in seen_
  std::vector<double> imposed_;                       // [N] (values) of one port
};

}  // namespace abut
