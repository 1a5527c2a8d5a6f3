#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "contract/subdomain.hpp"
#include "subdomain_solver/bars/bar_integrator.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// Our own subdomain: a bar, its integrator and its ports. Divides a window into substeps, tells
/// the integrator what acts on the ends in each of them, and collects the traces.
class BarBody final : public Subdomain {
 public:
  struct BodyPort {
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

  BarBody(std::string name, std::unique_ptr<Bar> bar, Scheme scheme,
          const std::vector<BodyPort>& ports);

  const Description& describe() const override { return description_; }
  void meet(int port, const PortGeometry& partner, const ContactLaw& law) override;
  void yields(int port, int partner, const PortKernel& kernel) override;
  void save() override;
  void restore() override;
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(int port, std::span<const double> patterns, double step, int count) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override;
  Grid grid() override;
  std::vector<FieldValues> fields() override;

  /// Called now and then during a long advance, so that the caller can tell others that the body
  /// lives.
  void set_progress(std::function<void()> hook) { progress_ = std::move(hook); }

 private:
  void describe_ports(const std::vector<BodyPort>& ports);
  std::optional<Failed> advance_window(const Advance& request, const Substeps& grid,
                                       Response& response);
  void find_same_grids(const Advance& request, const Substeps& grid);
  void set_actions(const Advance& request, const Substeps& grid, int i, EndActions& actions);
  void add_force(const Waveform& imposed, bool same_grid, const Substeps& grid, int i, int end,
                 EndAction& action) const;
  void set_obstacle(const Obstacle& obstacle, const Substeps& grid, int i, std::size_t port,
                    EndAction& action);
  void give_way(const Obstacle& obstacle, int i, std::size_t port, EndAction& action);
  void resist(const Impedance& impedance, const Substeps& grid, int i, int end,
              EndAction& action) const;
  void apply_impulses(const Advance& request);
  struct EndPlace {
    double outward = 0.0;  // [m] displacement of the end's node along its normal
    double force = 0.0;    // [N] compressive, that moves the body
  };
  using EndPlaces = std::array<EndPlace, 2>;
  EndPlaces end_places() const;
  void add_work(EndPlaces& before);
  void begin_traces(const Advance& request, Response& response);
  void push_trace(const Advance& request, double time, std::size_t p, Response& response);
  void push_traces(const Advance& request, double time, Response& response);
  void begin_sweep();
  void track_sweep();
  void end_sweep(Response& response) const;
  std::optional<Failed> record(double time, Response& response);
  void finish_ports(Response& response);
  double force_on_body(int end, const BoundaryData& data) const;
  void begin_reactions(const Advance& request, Response& response) const;
  void approach(int end, PortResponse& port) const;
  std::optional<Failed> check_finite(const BodyRecord& record) const;
  std::optional<Failed> check_compression(double time);
  std::vector<double> respond_from_rest(int end, double step, int count, double at_begin,
                                        double in_first);
  /// A partner that an end has met.
  struct Partner {
    double gap = 0.0;   // [m] of the references
    bool tied = false;  // holds in tension too
    PortKernel kernel;  // empty: gives way to nothing
  };
  /// What an end does in the present window.
  struct Imposed {
    std::vector<char> same_grid;  // by partner: a force is sampled at our own substeps
    int obstacle = -1;            // the partner behind it; -1: none
    bool same_motion = false;     // its motion is sampled at our own substeps
    std::vector<double> excess;   // [N] by substep: reaction minus that of the obstacle's motion
    double last = 0.0;            // [m] of the port where its trace ends
  };
  void report_progress();

  Description description_;
  std::unique_ptr<Bar> bar_;
  Scheme scheme_;
  std::vector<int> end_of_port_;
  ForceSupport support_[2] = {ForceSupport::nodal, ForceSupport::nodal};
  BarState state_;
  const Advance* request_ = nullptr;
  std::vector<std::byte> saved_;
  std::vector<std::vector<Partner>> partners_;  // by port
  std::vector<Imposed> imposed_;                // by port
  std::size_t recorded_ = 0;     // records of the window so far
  std::function<void()> progress_;
  double work_since_progress_ = 0.0;  // element-steps
};

}  // namespace abut
