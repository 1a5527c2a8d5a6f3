#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>

#include "base/life_signs.hpp"
#include "subdomain_solver/interior.hpp"

namespace abut {

/// Our subdomains, all of them: takes an interior through windows, keeps who its ports have met,
/// collects traces, swept boxes and records, saves and restores, and answers probes. A window costs
/// no allocation once buffers have grown.
class Body final : public Subdomain {
 public:
  /// `progress` is called now and then during a long advance, so that the caller can tell others
  /// that the body lives.
  explicit Body(std::unique_ptr<Interior> interior, std::function<void()> progress = {});

  const Description& describe() const override { return interior_->describe(); }
  void meet(const Meeting& meeting) override;
  void save() override;
  void restore() override;
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(const Probing& asked) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override;
  std::vector<double> measure() override { return interior_->measure(); }
  Grid grid() override { return interior_->grid(); }
  std::vector<FieldValues> fields() override { return interior_->fields(); }
  PassiveForm* passive() override;

 private:
  class Passive final : public PassiveForm {
   public:
    explicit Passive(Body& body) : body_(body) {}
    double enter() override;
    [[nodiscard]] Outcome leave(double time, double& lost) override;
    void start(const PassiveStep& step) override { step_ = &step; }
    [[nodiscard]] Outcome finish(PassiveReply& reply) override;
    double damp(double joules) override;

   private:
    Body& body_;
    const PassiveStep* step_ = nullptr;
  };

  void read_checkpoint(std::span<const std::byte> bytes);
  void take_from(Archive& archive);
  PortKernel probe_dynamics(const Probing& asked, std::span<const int> seen);
  PortKernel probe_statics(const Probing& asked, std::span<const int> seen);
  /// A port as substeps see it.
  struct Watched {
    const PortGeometry* geometry = nullptr;
    std::size_t first = 0, width = 0;  // of its values
    std::vector<double> lower, upper;  // [m] (dim) positions since the last record
    std::vector<double> before;        // [m] (width) displacements after the substep before
    // Of the window:
    const Want* want = nullptr;
    const std::vector<Obstacle>* obstacles = nullptr;
    PortResponse* reply = nullptr;
  };

  Window window_of(const Advance& request, const Substeps& grid) const {
    return {request, grid, partners_, neighbours_};
  }
  std::optional<Failed> advance(const Window& window, Response& response);
  template <class Visit>
  std::optional<Failed> walk(const Window& window, const Visit& visit);
  void look_ahead(const Advance& request, Response& response);
  void release_point(const Advance& request, const Waveform* own, std::size_t p,
                     Waveform& gone) const;
  void release(std::size_t port, const Advance& request, const Substeps& grid,
               const Waveform& trace);
  Substeps divide(const Advance& request) const;
  void begin_replies(const Advance& request, Response& response);
  void follow(const Window& window, int substep, double time, bool shown);
  void push_trace(const Watched& port, double time) const;
  void push_reactions(std::size_t port, double time) const;
  void list_reactions(std::size_t port);
  void begin_sweep();
  void widen_sweep();
  void widen_velocities(double length);
  std::optional<Failed> record(double time, Response& response);
  std::optional<Failed> tell(BodyRecord& record, double time);
  std::optional<Failed> respond(const Advance& request, const Substeps& grid,
                                std::span<const int> ports, std::vector<double>& displacement);
  /// With signs of life meanwhile, where a single call may take long.
  template <class Call>
  std::optional<Failed> patiently(const Call& call) const {
    if (!progress_ || !interior_->traits().slow) return call();
    LifeSigns life(progress_, life_interval);
    std::optional<Failed> outcome = call();
    life.end();
    return outcome;
  }
  void report_progress();

  static constexpr std::chrono::milliseconds life_interval{250};

  std::unique_ptr<Interior> interior_;
  Passive passive_{*this};
  std::function<void()> progress_;
  std::vector<Watched> ports_;
  std::vector<std::deque<Partner>> partners_;  // by port; contact holds on to them
  std::vector<PortKernel> neighbours_;         // by port; empty: none tied to this body
  const Advance* request_ = nullptr;
  const PortValues* seen_ = nullptr;
  std::size_t recorded_ = 0;  // records of the window so far
  std::vector<std::byte> saved_;
  Advance ahead_;                  // what is looked at after a window
  std::vector<double> pressing_;   // [N] (values) of a port, when it begins
  std::vector<std::byte> looked_;  // the state from which
  std::vector<double> at_begin_;   // [m] of the ports that respond() was asked for, at the begin
  std::vector<double> peeked_;     // [m] (steps, values of all ports) told without going there
  std::vector<std::int32_t> pressed_;  // points of a reaction
  double step_effort_ = 0.0;           // of a substep
  double effort_ = 0.0;                // since the last sign of life
};

}  // namespace abut
