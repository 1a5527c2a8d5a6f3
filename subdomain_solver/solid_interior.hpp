#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "subdomain_solver/contact/contact_fields.hpp"
#include "subdomain_solver/contact/port_contact.hpp"
#include "subdomain_solver/contact/self_crossings.hpp"
#include "subdomain_solver/contact/surface_contact.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/linearised_model.hpp"
#include "subdomain_solver/nodal_map.hpp"
#include "subdomain_solver/overlap/embedded_surface.hpp"
#include "subdomain_solver/passive/midpoint_step.hpp"
#include "subdomain_solver/passive/passive_body.hpp"
#include "subdomain_solver/passive/rigid_step.hpp"
#include "subdomain_solver/port_forces.hpp"
#include "subdomain_solver/port_forecast.hpp"
#include "subdomain_solver/port_statics.hpp"
#include "subdomain_solver/reactions.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// A solid: a mesh, the rung of the fidelity ladder that moves it, what acts on it, an integrator,
/// and ports that take forces. Linear ones answer for their kernels; massless ones meet obstacles.
class SolidInterior final : public Interior,
                            private Probed,
                            private Obstructed,
                            private Successor,
                            private PassiveBody {
 public:
  struct PortNodes {
    std::string name, side;
    bool tied = false;
    bool touched = false;         // something may touch it
    bool joined = false;          // tied to another surface: forces are constant in a step
    bool alike = true;            // to bodies that step as this one does
    EmbeddedSurface inside = {};  // of a body that overlaps this one
  };
  struct Scheme {
    std::unique_ptr<Integrator> integrator;
    double step = 0.0;         // [s]
    double stable_step = 0.0;  // [s]; infinity: none
    MassForm mass = MassForm::lumped;
    std::string words;  // for people
  };
  struct Parts {  // in the order of construction: later ones refer to earlier ones
    std::unique_ptr<FeModel> model;  // the mesh with its material and mass
    std::unique_ptr<Model> reduced;  // of rungs other than fe; null: the model of the mesh
    std::unique_ptr<NodalMap> map;   // from the problem's coordinates to the nodes
    std::unique_ptr<Problem> problem;
    Scheme scheme;
    Motion motion;  // q and v of the start
    std::vector<HeldCoordinates> constraints;
    std::unique_ptr<Reactions> reactions;             // null: no constraints
    std::vector<double> frequencies;                  // [Hz] of modal bodies, ascending
    std::function<double(double)> body_acceleration;  // [m/s^2] of time; null: none
    std::string rung = "fe";                          // for people
    bool deforms = true;                              // there is stress to tell of
    std::vector<double> loose;                        // Description::loose
    std::vector<std::unique_ptr<Load>> whole_loads;   // all mass on the nodes; empty: as problem's
    const RigidModel* rigid = nullptr;                // the problem's model, of a rigid body
    bool massive_surface = false;        // it has no layer, and takes obstacles when passive alone
    std::optional<double> pressed_over;  // [s] in which wanted interference grows; absent: none
  };

  SolidInterior(std::string name, Parts parts, const std::vector<PortNodes>& ports);
  void state(Archive& archive) override;
  std::size_t coordinates() const override { return state_.motion.q.size(); }
  void restored() override;
  std::optional<Failed> begin(const Window& window) override;
  void set_off(const Window& window) override;
  std::optional<Failed> step(const Window& window, int i, bool whole) override;
  const PortValues& see(const Window& window, double time, bool all) override;
  std::optional<Failed> record(BodyRecord& record) override;
  void finish(std::size_t port, PortResponse& reply) const override;
  std::vector<double> measure() override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

 private:
  double compliance(std::size_t port) const override;
  double light_force(std::size_t port) const override;
  bool rest(std::size_t port) override;
  void wake() override;
  std::string misfit(int port, const PortKernel& kernel) const override;
  void react(std::size_t port, std::size_t partner, std::vector<double>& force) const override;
  const std::vector<std::int32_t>* reacting(std::size_t port, std::size_t partner) const override {
    return surfaces_ != nullptr ? surfaces_->reacting(port, partner) : nullptr;
  }
  void take_over(Archive& archive, Before by) override;
  void take_from(const HandOver& handed) override;
  std::vector<double> amplitudes_of(std::vector<double> nodes) const;
  std::optional<Failed> settle_swap();
  void keep_momenta(const BodyRecord& before);
  double enter() override;
  std::optional<Failed> leave(double time, double& lost) override;
  double damp(double joules) override;
  std::optional<Failed> pass(const PassiveStep& step, PassiveReply& reply) override;

  /// Then it has no accelerations; motion.force is that of its supports, of modes what moves them.
  bool is_passive() const { return state_.begun && state_.motion.a.empty(); }
  double come_to_rest();
  std::optional<Failed> stand_still(double time);
  void find_passive();
  void start_passive();
  void take_impulses(const PassiveStep& step);
  std::optional<Failed> pass_guarded(const PassiveStep& step, PassiveReply& reply);
  std::optional<Failed> step_modes(const PassiveStep&step), step_guarded(const PassiveStep&step);
  double store_guarded();
  std::optional<Failed> restart(double time, double& work);
  void spread_velocities();
  void hand_on(Vector& impulse);
  void gather_velocities();
  double held_energy() const;
  void keep_momentum(const Eigen::MatrixXd& motions, const Vector& momentum);
  template <class Energy>
  void keep_momenta(const Vector& momentum, double most, const Energy& energy);
  std::optional<Failed> turned_otherwise(const Vector& momentum, double time);
  Vector nodal_momentum();
  Eigen::MatrixXd free_motions(bool turns);
  Vector mean_motion();
  const SparseMatrix& mass_of_form() const { return is_passive() ? whole_mass_ : mass_; }
  double take_from_deformation(double joules);
  double take_beside_joints(double joules);
  double moving_energy() const;

  struct State {
    double time = 0.0;  // [s]
    Motion motion;
    bool begun = false;              // accelerations and forces of the start are there
    std::vector<double> port_force;  // [N] (port values) that acts now
    double port_work = 0.0;          // [J] done by forces on the ports
    PortForces::Left light;          // by joined sides, after the last substep
    double turned = 0.0;             // [rad] largest rotation at records, where the law is linear
    double crossed = 0.0;            // most pairs of facets that crossed each other, at records
  };
  bool stabilised() const;  // because contact alone holds it
  void describe(std::string name, const std::vector<PortNodes>& ports);
  void find_traits();
  void find_abilities();
  Energy energy() const;
  std::size_t nodal_values() const { return index(parts_.model->dofs()); }
  bool probed_as_linear() const;
  void see_nodes();
  void add_lag();
  void shift_lag(double share);
  void leave_out_unknown(std::vector<double>& forces) const;
  const Vector& forces_now();
  void see_places();
  std::optional<Failed> meet_port_forces(double time);
  std::optional<Failed> meet_end();
  std::optional<Failed> take_port_forces(double time);
  void find_contacts();
  void find_surfaces();
  void watch_crossings();
  void follow_ports(double time);
  void add_port_work();
  void state_of_motion(Archive& archive);
  void add_work_of_impulses();
  const Vector& forces_on_ports();
  void reactions(std::vector<double>& out);
  FieldValues nodal_reactions();

  Parts parts_;
  SparseMatrix mass_;  // [kg] of the nodes, in the form of the scheme
  std::vector<NamedNodes> ports_;
  std::vector<char> may_touch_, joined_;      // (ports)
  bool joins_ = false;                        // one of them is joined
  std::unique_ptr<PortMap> port_map_;         // null: no ports
  std::unique_ptr<PortContact> contact_;      // null: no port meets obstacles
  SurfaceContact* surfaces_ = nullptr;        // the same of ports that are surfaces; null: points
  std::vector<TouchedSurface> touched_;       // its ports, where they are surfaces
  std::unique_ptr<SelfCrossings> crossings_;  // null: strains are small
  PortForces* port_forces_ = nullptr;         // owned by the problem, the last of its loads
  State state_;
  std::optional<BodyRecord> swapped_;  // as another model has left the body; the begin settles it
  bool stands_ = false;         // it has taken over a state in balance, which no window has left
  std::vector<double> worked_;  // [J] (ports) that came through them in the window so far
  PortValues seen_;
  int substep_ = 0;                  // the last one of the window
  std::unique_ptr<Problem> loaded_;  // the problem with its loads, while the body is probed
  std::unique_ptr<LinearisedModel> linearised_;  // and its model for small motions
  std::vector<double> u_, v_;  // (nodes, dim) along the axes of space, as see_nodes() left them
  std::vector<double> lag_;    // [m/s] of velocities behind the impulses
  Vector momentum_, behind_, nodes_behind_;  // [kg m/s]; behind the impulses: of coordinates, nodes
  std::vector<double> places_, left_, before_, now_;  // [m] (left by a substep), [N] (port values)
  mutable Vector change_, on_ports_;                  // [N] (coordinates), (nodes, dim)
  std::unique_ptr<PortForecast> forecast_;            // null: only walks tell where ports go
  std::unique_ptr<PortStatics> statics_;              // null: the body has inertia, or no ports
  std::unique_ptr<MidpointStep> midpoint_;  // of the passive form; null: none, or another one
  std::unique_ptr<RigidStep> rigid_step_;
  SparseMatrix whole_mass_, given_mass_;  // [kg] (nodal values) of the nodes, when first asked for
};

}  // namespace abut
