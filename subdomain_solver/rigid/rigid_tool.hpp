#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/passive/passive_body.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

/// A rigid shape in two or three dimensions on a given way: a wall where it stands, a die, a punch.
/// Takes any force and goes where it is told; its energy and momentum are nobody's.
class RigidTool final : public Interior, private PassiveBody {
 public:
  /// Displacement [m] along an axis, of time [s].
  using Way = std::function<double(double)>;
  /// `way`: one per dimension. `step`: [s] by which its way is told; 0: of windows.
  RigidTool(std::string name, std::unique_ptr<FeModel> shape, std::vector<Way> way, double step,
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

  std::optional<Failed> go_to(double time, const std::vector<double>& mean);
  void mean_force(const Window& window, double time, std::vector<double>& mean);
  std::optional<Failed> move_to(const Window& window, double time);

  struct State {
    double time = 0.0;             // [s]
    std::vector<double> place;     // [m] (dim) now
    std::vector<double> force;     // [N] (dim) of all partners now
    double work = 0.0;             // [J] that it has done on them
    std::vector<double> velocity;  // [m/s] (dim) over the last step
  };

  std::unique_ptr<FeModel> shape_;
  std::vector<Way> way_;
  State state_;
  PortValues seen_;
  std::vector<double> shown_place_, shown_velocity_;  // that seen_ tells of
  bool pushed_ = false;                               // there are forces in seen_
  std::vector<double> imposed_;  // [N] (values) of one port
};

}  // namespace abut
