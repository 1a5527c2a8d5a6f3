#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/nodal_map.hpp"
#include "subdomain_solver/port_forces.hpp"
#include "subdomain_solver/reactions.hpp"
#include "subdomain_solver/solid_measures.hpp"
#include "subdomain_solver/substeps.hpp"
#include "subdomain_solver/time/integrator.hpp"

namespace abut {

/// Our subdomain in one, two and three dimensions: a mesh, the rung of the fidelity ladder whose
/// coordinates move it, what acts on it, an integrator, and ports, which are sides or node sets of
/// the mesh. Ports take forces; linear bodies answer for their port kernels too. A node of a port
/// keeps its mass.
class SolidBody final : public Subdomain {
 public:
  struct PortNodes {
    std::string name, side;
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
    std::unique_ptr<Reactions> reactions;  // null: no constraints
    std::vector<double> frequencies;       // [Hz] of modal bodies, ascending
    std::string rung = "fe";               // for people
    bool deforms = true;                   // there is stress to tell of
  };

  SolidBody(std::string name, Parts parts, const std::vector<PortNodes>& ports);

  const Description& describe() const override { return description_; }
  void meet(int, const PortGeometry&, const ContactLaw&) override {}  // takes no obstacles
  void yields(int, int, const PortKernel&) override {}
  void save() override;
  void restore() override;
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(int port, std::span<const double> patterns, double step, int count) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override { return hash_state(state_); }
  std::vector<double> measure() override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

  void set_progress(std::function<void()> hook) { progress_ = std::move(hook); }

 private:
  struct State {
    double time = 0.0;  // [s]
    Motion motion;
    bool begun = false;              // accelerations and forces of the start are there
    std::vector<double> port_force;  // [N] (port values) that acts now
    double port_work = 0.0;          // [J] done by forces on the ports
    double turned = 0.0;             // [rad] largest rotation at records, where the law is linear
    void state(Archive& archive) {
      archive.field("time", time);
      motion.state(archive);
      archive.field("begun", begun);
      archive.field("port_force", port_force);
      archive.field("port_work", port_work);
      archive.field("turned", turned);
    }
  };

  void describe(std::string name, const std::vector<PortNodes>& ports);
  Port port_of(const PortNodes& port, const std::vector<std::int32_t>& list) const;
  Energy energy() const;
  std::optional<Failed> advance(const Advance& request, const Substeps& grid, Response& response);
  std::size_t nodal_values() const { return index(parts_.model->dofs()); }
  std::vector<double> displacement() const;
  std::vector<double> velocity() const;
  void meet_port_forces(double time);
  void see_ports();
  void follow_ports(double time);
  std::vector<double> respond_from_rest(std::size_t port, const Substeps& grid);
  void push_traces(const Advance& request, double time, Response& response) const;
  void widen_sweep();
  void begin_sweep();
  void end_sweep(Response& response) const;
  std::optional<Failed> record(double time, Response& response);
  Vector momentum_of_nodes() const;
  Vector forces_on_ports() const;
  std::vector<double> reactions() const;
  std::optional<Failed> patiently(const std::function<std::optional<Failed>()>& call) const;
  void report_progress();

  Parts parts_;
  SparseMatrix mass_;  // [kg] of the nodes, in the form of the scheme
  Description description_;
  std::vector<NamedNodes> ports_;
  std::unique_ptr<PortMap> port_map_;      // null: no ports
  PortForces* port_forces_ = nullptr;      // owned by the problem, the last of its loads
  std::vector<double> port_displacement_;  // [m] (port values) now
  State state_;
  const Advance* request_ = nullptr;
  std::vector<std::byte> saved_;
  std::size_t recorded_ = 0;
  std::vector<std::vector<double>> lower_, upper_;  // [m] (dim) by port, since the last record
  std::function<void()> progress_;
  double work_since_progress_ = 0.0;  // cell-steps
};

}  // namespace abut
