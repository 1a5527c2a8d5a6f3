#include "coordinator/coupling/bodies.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {
/// Samples kept for the median of the overhead per exchange; later ones add nothing to it.
constexpr std::size_t overhead_samples = 1u << 20;
/// A body in this process shares its memory: when that ends, the body is to be named.
Outcome finish(Subdomain& body, Response& response) {
  try {
    return body.finish(response);
  } catch (const std::bad_alloc&) {
    throw RunError(fmt::format("body '{}' has used up the memory", body.describe().name), "",
                   "Make its mesh coarser, or give shorter windows and fewer records.");
  }
}

}  // namespace

Bodies::Bodies(std::vector<Subdomain*> subdomains)
    : subdomains_(std::move(subdomains)),
      requests_(subdomains_.size()),
      responses_(subdomains_.size()),
      everybody_(subdomains_.size()),
      compute_seconds_(subdomains_.size(), 0.0) {
  std::iota(everybody_.begin(), everybody_.end(), 0);
  for (std::size_t b = 0; b < subdomains_.size(); ++b) {
    requests_[b].boundary.resize(subdomains_[b]->describe().ports.size());
  }
}

void Bodies::save_all() {
  for (Subdomain* body : subdomains_) body->save();
}

void Bodies::restore_all() {
  for (Subdomain* body : subdomains_) body->restore();
}

void Bodies::prepare(const TimeWindow& window, int records, Sampling sampling) {
  struck_.assign(subdomains_.size(), 0.0);
  for (Advance& request : requests_) {
    request.window = window;
    request.records = records;
    request.sampling = sampling;
    for (BoundaryData& data : request.boundary) data.clear();
  }
}

std::optional<Failed> Bodies::advance(std::span<const int> bodies) {
  const auto began = std::chrono::steady_clock::now();
  for (int b : bodies) (*this)[b].start(request(b));
  std::optional<Failed> failed;
  double slowest = 0.0;
  for (int b : bodies) {
    Response& response = responses_[index(b)];
    Outcome outcome = finish((*this)[b], response);
    ++exchanges_;
    if (Failed* failure = std::get_if<Failed>(&outcome); failure != nullptr) {
      failure->detail = "body '" + describe(b).name + "': " + failure->detail;
      if (!failed) failed = std::move(*failure);
      continue;
    }
    compute_seconds_[index(b)] += response.compute_seconds;
    slowest = std::max(slowest, response.compute_seconds);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  if (overhead_.size() < overhead_samples && !bodies.empty()) {
    overhead_.push_back(static_cast<float>(wall.count() - slowest));
  }
  return failed;
}

std::optional<Failed> Bodies::advance_all() { return advance(everybody_); }

void Bodies::strike_record(const Side& side, double impulse) {
  Response& response = responses_[index(side.body)];
  PortResponse& port = response.ports[index(side.port)];
  if (impulse == 0.0 || !port.recoil) return;
  BodyRecord& record = response.records.back();
  const double before = port.recoil->velocity;
  port.recoil->velocity -= impulse * port.recoil->mobility;
  const double work = -impulse * 0.5 * (before + port.recoil->velocity);
  record.energy.kinetic += work;
  struck_[index(side.body)] += work;
  const Port& described = describe(side.body).ports[index(side.port)];
  if (port.recoil->mobility > 0.0) record.momentum[0] -= impulse * described.geometry.normals[0];
}

const PortKernel& Bodies::kernel(int body, int port, int count) {
  auto same = [body, port](const CachedKernel& k) { return k.body == body && k.port == port; };
  auto found = std::find_if(kernels_.begin(), kernels_.end(), same);
  if (found == kernels_.end()) {
    kernels_.push_back({body, port, {}});
    found = kernels_.end() - 1;
  }
  if (static_cast<int>(found->kernel.displacement.size()) < count) {
    const double step = describe(body).step;
    found->kernel =
        (*this)[body].kernel(port, step > 0.0 ? step : request(body).window.length(), count);
    ++exchanges_;
  }
  return found->kernel;
}

double Bodies::overhead_median() const {
  if (overhead_.empty()) return 0.0;
  std::vector<float> sorted = overhead_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return static_cast<double>(*middle);
}

}  // namespace abut
