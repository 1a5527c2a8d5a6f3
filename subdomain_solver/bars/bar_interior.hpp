#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "subdomain_solver/bars/bar_integrator.hpp"
#include "subdomain_solver/bars/bar_loads.hpp"
#include "subdomain_solver/bars/bar_midpoint.hpp"
#include "subdomain_solver/contact/point_obstacle.hpp"
#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/passive/passive_body.hpp"

namespace abut {

/// A bar, its integrator and its ends: tells the integrator what acts on the ends in each substep.
class BarInterior final : public Interior, private Probed, private Obstructed, private PassiveBody {
 public:
  struct End {
    std::string name;
    int end = 0;  // 0 left, 1 right
    bool tied = false;
  };
  struct Scheme {
    std::unique_ptr<BarIntegrator> integrator;
    double step = 0.0;  // [s]
    bool explicit_in_time = true;
    std::string words;      // for people
    bool conserves = true;  // the energies that its integrator tells
  };
  /// What a bar starts with besides its uniform velocity, and what acts on it besides its body
  /// force: absent where there is none.
  struct Extras {
    std::vector<double> displacement, velocity;  // [m] [m/s] (nodes)
    std::unique_ptr<BarLoads> loads;
  };

  BarInterior(std::string name, std::unique_ptr<Bar> bar, Scheme scheme,
              const std::vector<End>& ends, Extras extras);

  void state(Archive& archive) override;
  std::size_t coordinates() const override;
  void restored() override;
  std::optional<Failed> begin(const Window& window) override;
  void set_off(const Window& window) override;
  std::optional<Failed> step(const Window& window, int i, bool whole) override;
  const PortValues& see(const Window& window, double time, bool all) override;
  std::optional<Failed> record(BodyRecord& record) override;
  void finish(std::size_t port, PortResponse& reply) const override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

 private:
  double compliance(std::size_t port) const override;
  double light_force(std::size_t) const override { return 1.0; }
  bool rest(std::size_t port) override;
  void wake() override { probed_ = -1; }

  double enter() override;
  std::optional<Failed> leave(double time, double& lost) override;
  double damp(double joules) override;
  std::optional<Failed> pass(const PassiveStep& step, PassiveReply& reply) override;
  /// Then it has no accelerations.
  bool is_passive() const { return state_.a.empty(); }
  double energy() const;  // [J] kinetic and stored
  void keep_energy(double before);
  double take_from_deformation(double joules);
  void let_go();
  void pass_loads(const PassiveStep& step, std::vector<double>& force);

  std::string misfit(int port, const PortKernel& kernel) const override;
  const std::vector<std::int32_t>* reacting(std::size_t, std::size_t) const override {
    return nullptr;
  }
  void react(std::size_t port, std::size_t partner, std::vector<double>& force) const override;

  /// What an end does in the present window.
  struct Imposed {
    std::vector<char> same_grid;  // by partner: a force is sampled at our own substeps
    PointObstacle obstacle;
  };
  struct EndPlace {
    double outward = 0.0;  // [m] displacement of the end's node along its normal
    double force = 0.0;    // [N] compressive, that moves the body
  };
  using EndPlaces = std::array<EndPlace, 2>;
  struct Shown {
    double time = 0.0, u = 0.0;  // of the last entry of a port's trace
  };

  void describe(std::string name, const std::vector<End>& ends);
  void set_fields(const Extras& extras);
  void lie_down();
  bool loaded() const { return loads_ != nullptr && probed_ < 0; }
  void start(const Window& window);
  void meet_loads(double time);
  void bear_loads(double time);
  void add_load_work();
  double external_work() const;
  void see_imposed(const Window& window);
  void set_actions(const Window& window, int i);
  void add_force(const Waveform& imposed, bool same_grid, const Substeps& grid, int i, int end,
                 EndAction& action) const;
  void set_obstacle(int i, std::size_t port, EndAction& action);
  void resist(const Impedance& impedance, const Substeps& grid, int i, int end,
              EndAction& action) const;
  EndPlaces end_places() const;
  void add_work();
  double force_on_body(int end, const BoundaryData& data) const;
  void approach(int end, PortResponse& reply) const;

  std::unique_ptr<Bar> bar_;
  Scheme scheme_;
  std::vector<int> ends_;  // by port
  BarState state_;
  EndActions actions_;
  std::vector<Imposed> imposed_;  // by port
  bool driven_ = false;           // something is imposed
  bool open_ = false;             // v is of a half step
  EndPlaces places_{};
  std::vector<Shown> shown_;  // by port
  PortValues seen_;
  int probed_ = -1;  // the port that is held

  std::unique_ptr<BarLoads> loads_;  // null: none
  bool late_ = false;                // the start waits for the loads and obstacles that it finds
  bool begun_ = true;                // it has found them
  double load_work_ = 0.0;           // [J] done by the loads
  double lifted_ = 0.0;              // [kg m] M u of the start, from which weight's work counts
  std::vector<double> worked_;       // [m] (nodes) places up to which the loads' work is told
  std::unique_ptr<BarMidpoint> midpoint_;  // null: it was never passive
};

}  // namespace abut
