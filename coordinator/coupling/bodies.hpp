#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "base/span.hpp"
#include "contract/subdomain.hpp"

namespace abut {

class PortPose;

/// One end of a joint.
struct Side {
  int body = 0, port = 0;
  int partner = 0;  // number of the other end among those that the port meets
};

/// The bodies of a run with their requests and responses, by index. Every exchange passes through
/// here, so this is where exchanges are counted and timed. Times never decide anything.
class Bodies {
 public:
  /// `window` [s]: a whole one, which is the step of bodies that have none.
  explicit Bodies(std::vector<Subdomain*> subdomains, double window = 0.0);

  ~Bodies();

  int count() const { return static_cast<int>(subdomains_.size()); }
  Subdomain& operator[](int body) { return *subdomains_[body]; }
  const Description& describe(int body) const {
    const auto told = told_.find(body);
    return told == told_.end() ? subdomains_[body]->describe() : told->second;
  }
  /// From now on describe() tells this of a body: its facets look to the other side.
  void tell_of(int body, Description told) { told_.insert_or_assign(body, std::move(told)); }
  /// By body, its distance to what supports hold (see support_distances).
  void tell_supports(std::vector<std::optional<int>> of) { supports_ = std::move(of); }
  std::optional<int> support_distance(int body) const {
    return supports_.empty() ? std::nullopt : supports_[index(body)];
  }
  /// The passive form of a body that is about to get one request of it, which counts.
  PassiveForm& ask_passively(int body) {
    ++exchanges_;
    return *subdomains_[body]->passive();
  }
  /// Of the side that has less. Of sides that have as much, but for roundings, that whose body's
  /// name and port's come first: however a scene lists bodies, interfaces and their sides.
  int side_of_less(const std::array<Side, 2>& sides, double one, double other) const;
  const Port& port(const Side& side) const { return describe(side.body).ports[side.port]; }
  Advance& request(int body) { return requests_[body]; }
  const Advance& request(int body) const { return requests_[body]; }
  const Response& response(int body) const { return responses_[body]; }
  /// For who advances bodies without requests; see_anew() afterwards.
  Response& response(int body) { return responses_[body]; }
  void see_anew();
  std::span<const Response> responses() const { return responses_; }

  /// What the next request imposes on one end of a joint.
  BoundaryData& boundary(const Side& side) { return request(side.body).boundary[side.port]; }
  Waveform& force(const Side& side);
  Obstacle& obstacle(const Side& side);
  /// What the latest response of one end does to the other.
  const Waveform& reaction(const Side& side) const;

  /// Where the surface of one end stands by its latest response; made when it is asked for.
  const PortPose& pose(const Side& side) const;
  /// Whether the latest responses are of an attempt that was taken back.
  bool taken_back() const { return taken_back_; }

  /// Who is told what the run's time goes into; empty: nobody.
  void tell_spans(SpanSink sink) { spans_ = std::move(sink); }
  const SpanSink& spans() const { return spans_; }

  /// Counts meetings of pairs of sides.
  int next_meeting() { return meetings_++; }
  /// Numbers the partner of a side, and tells it whom it may meet where it takes obstacles.
  void meet(Side& side, const PortGeometry& partner, const ContactLaw& law);
  /// Fields of the traces that later responses are to hold.
  void want(const Want& fields);

  void save_all();
  void restore_all();
  /// Clears what is imposed on all ports and sets the window of all requests.
  void prepare(const TimeWindow& window, int records, Sampling sampling);
  /// Advances the listed bodies at once; replies are taken by index, so arrival order changes
  /// nothing.
  [[nodiscard]] std::optional<Failed> advance(std::span<const int> bodies);
  [[nodiscard]] std::optional<Failed> advance_all();

  /// What pressed on partners at the end of a stage goes on pressing when the next one begins,
  /// though its bodies have not been asked yet: reactions of earlier responses, where the latest
  /// have none.
  void keep_reactions(std::span<const Response> earlier);

  /// An impulse [N s] into a port at the end of the last window, with which the next one begins:
  /// its body's last record tells of the state after it.
  void strike_record(const Side& side, double impulse);
  /// The latest response of a body whose velocities have changed since, at a time [s]: what
  /// impulses into its ports would meet now.
  void see_recoil(int body, double time);
  /// The same of the energy alone, of an impulse that comes after another one, which is not told.
  void strike_energy(const Side& side, double earlier, double impulse);
  /// [J] by body, of such impulses: in the last records, and in the ports' work of the next window.
  std::span<const double> struck() const { return struck_; }

  /// Mean response of a port's points along its outward normals to a unit force on every point
  /// along them: one pattern of one value.
  const PortKernel& kernel(int body, int port, int count);

  /// Response of every value of a port's points to a unit force on every one, at levels. `points`:
  /// ascending; empty: all.
  PortKernel full_kernel(int body, int port, int count, const std::vector<std::int32_t>& points);

  /// Tells the kinematic side how its partner's surface gives way, or for `own_surface` how its own
  /// one does; `of` is whose kernel it is.
  void meet(const Side& kinematic, int partner, const Side& of, const PortKernel& kernel);

  /// [s] of a body's steps in the window that is requested: its own, or all of a shorter window.
  double step(int body) const;
  /// Responses of some ports, one after the other, to patterns of force on one of them, in such
  /// steps; so are those of full_kernel().
  PortKernel probe(int body, int port, std::span<const double> patterns, int count,
                   std::span<const int> seen);

  /// [m/(N s)] (substeps) outward displacement of a port of one point after a unit impulse against
  /// its normal at the begin of a window, of a linear body. Precondition: all stand as saved.
  std::vector<double> impulse_response(const Side& side, const TimeWindow& window);

  /// Latest responses and what was told of the bodies, between windows.
  void state(Archive& archive);
  void ends(Archive& archive);    // the first part of it: the latest responses
  void counts(Archive& archive);  // of the run for its end alone

  double shortest_step() const;              // [s] of all bodies, at most a window
  double window() const { return window_; }  // [s] a whole one
  double longest_step() const;               // [s] of those that have one; a window where none has
  std::int64_t exchanges() const { return exchanges_; }
  /// [s] that a body has told of a passive step.
  void add_compute(int body, double seconds) { compute_seconds_[index(body)] += seconds; }
  const std::vector<double>& compute_seconds() const { return compute_seconds_; }
  double overhead_median() const;  // [s] per exchange: wall minus compute

 private:
  struct CachedKernel {
    int body = 0, port = 0;
    PortKernel kernel;
  };
  using Kernels = std::deque<CachedKernel>;  // references to kernels stay valid
  static PortKernel& cached(Kernels& kernels, int body, int port);
  PortKernel ask(int body, double step, Probing probing);

  std::vector<Subdomain*> subdomains_;
  std::map<int, Description> told_;  // of what describes itself otherwise
  std::vector<std::optional<int>> supports_;
  double window_;  // [s]
  std::vector<Advance> requests_;
  std::vector<Response> responses_;
  // Where answers arrive: what a body that fails leaves in a response is nobody's answer, and not
  // the same in its own process and in this one.
  std::vector<Response> answers_;
  std::vector<std::vector<std::unique_ptr<PortPose>>> poses_;  // by body and port
  std::vector<std::vector<int>> partners_;                     // met so far, by body and port
  int meetings_ = 0;
  bool taken_back_ = false;
  std::vector<double> struck_;
  std::vector<int> everybody_;
  Kernels kernels_;
  std::int64_t exchanges_ = 0;
  std::vector<double> compute_seconds_;
  std::vector<float> overhead_;
  SpanSink spans_;
};

}  // namespace abut
