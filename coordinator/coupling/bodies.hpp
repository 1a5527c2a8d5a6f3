#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/coupling/side.hpp"

namespace abut {

/// The bodies of a run with their requests and responses, by index. Every exchange passes through
/// here, so this is where exchanges are counted and timed. Times never decide anything.
class Bodies {
 public:
  explicit Bodies(std::vector<Subdomain*> subdomains);

  int count() const { return static_cast<int>(subdomains_.size()); }
  Subdomain& operator[](int body) { return *subdomains_[index(body)]; }
  const Description& describe(int body) const { return subdomains_[index(body)]->describe(); }
  Advance& request(int body) { return requests_[index(body)]; }
  const Response& response(int body) const { return responses_[index(body)]; }
  std::span<const Response> responses() const { return responses_; }

  void save_all();
  void restore_all();
  /// Clears what is imposed on all ports and sets the window of all requests.
  void prepare(const TimeWindow& window, int records, Sampling sampling);
  /// Advances the listed bodies at once; replies are taken by index, so arrival order changes
  /// nothing.
  [[nodiscard]] std::optional<Failed> advance(std::span<const int> bodies);
  [[nodiscard]] std::optional<Failed> advance_all();

  /// An impulse [N s] into a port at the end of the last window, with which the next one begins:
  /// its body's last record tells of the state after it.
  void strike_record(const Side& side, double impulse);
  /// [J] by body, of such impulses: in the last records, and in the ports' work of the next window.
  std::span<const double> struck() const { return struck_; }

  const PortKernel& kernel(int body, int port, int count);

  std::int64_t exchanges() const { return exchanges_; }
  const std::vector<double>& compute_seconds() const { return compute_seconds_; }
  double overhead_median() const;  // [s] per exchange: wall minus compute

 private:
  struct CachedKernel {
    int body = 0, port = 0;
    PortKernel kernel;
  };

  std::vector<Subdomain*> subdomains_;
  std::vector<Advance> requests_;
  std::vector<Response> responses_;
  std::vector<double> struck_;
  std::vector<int> everybody_;
  std::deque<CachedKernel> kernels_;  // references to kernels stay valid
  std::int64_t exchanges_ = 0;
  std::vector<double> compute_seconds_;
  std::vector<float> overhead_;
};

}  // namespace abut
