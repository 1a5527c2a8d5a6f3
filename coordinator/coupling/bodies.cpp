#include "coordinator/coupling/bodies.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <new>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/nearly.hpp"
#include "contract/kernel_parts.hpp"
#include "coordinator/coupling/kernel_support.hpp"
#include "coordinator/coupling/port_pose.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {
/// Samples kept for the median of the overhead per exchange; later ones add nothing to it.
constexpr std::size_t overhead_samples = 1u << 20;
/// [B] of a kernel that is asked for at once, about: it is wider than what is kept of it.
constexpr double probe_bytes = 3.2e7;
/// Of a step: what is left of a window and less than this is none.
constexpr double remainder = 1.0e-6;
/// Means over a port's points of the responses of a kernel of one pattern, along the normals.
PortKernel along(const PortKernel& all, const PortGeometry& surface) {
  const std::vector<double>& normals = surface.normals;
  ABUT_ASSERT(all.patterns == 1 && index(all.width) == normals.size());
  const auto mean = [&normals, count = surface.count()](const std::vector<double>& values) {
    std::vector<double> out(values.size() / normals.size(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k)
      out[k / normals.size()] += normals[k % normals.size()] * values[k] / count;
    return out;
  };
  return {all.step,
          all.support,
          1,
          1,
          surface.count() == 1 ? mean(all.compliance) : std::vector<double>(),
          mean(all.displacement),
          mean(all.begin),
          {},
          {},
          {},
          {}};
}

/// The responses of some points alone, to patterns of as many.
PortKernel cut(PortKernel all, const std::vector<std::int32_t>& points, std::size_t dim) {
  all.points = points;
  if (points.empty()) return all;
  const std::size_t width = index(all.width), least = points.size() * dim;
  const auto keep = [&](std::vector<double>& values) {
    const std::size_t rows = values.size() / width;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t k = 0; k < least; ++k)
        values[r * least + k] = values[r * width + index(points[k / dim]) * dim + k % dim];
    values.resize(rows * least);
    values.shrink_to_fit();
  };
  keep(all.compliance);
  keep(all.displacement);
  keep(all.begin);
  all.width = static_cast<int>(least);
  return all;
}

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

Bodies::Bodies(std::vector<Subdomain*> subdomains, double window)
    : subdomains_(std::move(subdomains)),
      window_(window),
      requests_(subdomains_.size()),
      responses_(subdomains_.size()),
      answers_(subdomains_.size()),
      poses_(subdomains_.size()),
      partners_(subdomains_.size()),
      everybody_(subdomains_.size()),
      compute_seconds_(subdomains_.size(), 0.0) {
  std::iota(everybody_.begin(), everybody_.end(), 0);
  for (std::size_t b = 0; b < subdomains_.size(); ++b) {
    requests_[b].boundary.resize(subdomains_[b]->describe().ports.size());
    partners_[b].resize(requests_[b].boundary.size(), 0);
    for (std::size_t p = 0; p < requests_[b].boundary.size(); ++p)
      poses_[b].push_back(std::make_unique<PortPose>());
  }
}

Bodies::~Bodies() = default;

Waveform& Bodies::force(const Side& side) {
  std::vector<Waveform>& forces = boundary(side).forces;
  if (forces.size() <= index(side.partner)) forces.resize(index(side.partner) + 1);
  return forces[side.partner];
}

Obstacle& Bodies::obstacle(const Side& side) {
  std::vector<Obstacle>& obstacles = boundary(side).obstacles;
  if (obstacles.size() <= index(side.partner)) obstacles.resize(index(side.partner) + 1);
  return obstacles[side.partner];
}

const Waveform& Bodies::reaction(const Side& side) const {
  return response(side.body).ports[side.port].reactions.at(index(side.partner)).force;
}

const PortPose& Bodies::pose(const Side& side) const {
  PortPose& pose = *poses_[side.body][side.port];
  pose.see(port(side).geometry, response(side.body).ports[side.port].trace);
  return pose;
}

void Bodies::meet(Side& side, const PortGeometry& partner, const ContactLaw& law) {
  side.partner = partners_[side.body][side.port]++;
  if (describe(side.body).can.obstacle)
    (*this)[side.body].meet({side.port, side.partner, &partner, law});
}

void Bodies::want(const Want& fields) {
  for (Advance& request : requests_) request.want.assign(request.boundary.size(), fields);
}

void Bodies::save_all() {
  for (Subdomain* body : subdomains_) body->save();
}

void Bodies::restore_all() {
  for (Subdomain* body : subdomains_) body->restore();
  taken_back_ = true;
}

void Bodies::prepare(const TimeWindow& window, int records, Sampling sampling) {
  struck_.assign(subdomains_.size(), 0.0);
  for (Advance& request : requests_) {
    request.window = window;
    request.records = records;
    request.sampling = sampling;
    request.ahead = 0.0;
    request.carry.clear();
    for (BoundaryData& data : request.boundary) {
      data.clear();
      for (Obstacle& obstacle : data.obstacles) obstacle.motion.width = 1;  // no trace of the past
    }
  }
}

std::optional<Failed> Bodies::advance(std::span<const int> bodies) {
  const auto began = std::chrono::steady_clock::now();
  for (int b : bodies) (*this)[b].start(request(b));
  taken_back_ = false;
  std::optional<Failed> failed;
  double slowest = 0.0;
  for (int b : bodies) {
    Response& response = answers_[b];
    Outcome outcome = finish((*this)[b], response);
    ++exchanges_;
    if (Failed* failure = std::get_if<Failed>(&outcome); failure != nullptr) {
      failure->detail = "body '" + describe(b).name + "': " + failure->detail;
      if (!failed) failed = std::move(*failure);
      continue;
    }
    std::swap(responses_[b], response);
    for (const auto& pose : poses_[b]) pose->forget();
    compute_seconds_[b] += responses_[b].compute_seconds;
    slowest = std::max(slowest, responses_[b].compute_seconds);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  if (overhead_.size() < overhead_samples && !bodies.empty()) {
    overhead_.push_back(static_cast<float>(wall.count() - slowest));
  }
  return failed;
}

int Bodies::side_of_less(const std::array<Side, 2>& sides, double one, double other) const {
  if (!nearly_equal(one, other)) return one < other ? 0 : 1;
  const auto name = [this](const Side& side) {
    return std::tie(describe(side.body).name, port(side).name);
  };
  return name(sides[1]) < name(sides[0]) ? 1 : 0;
}

void Bodies::see_anew() {
  taken_back_ = false;
  for (const auto& poses : poses_)
    for (const auto& pose : poses) pose->forget();
}

std::optional<Failed> Bodies::advance_all() { return advance(everybody_); }

void Bodies::strike_record(const Side& side, double impulse) {
  Response& response = responses_[side.body];
  PortResponse& reply = response.ports[side.port];
  if (impulse == 0.0 || !reply.recoil) return;
  BodyRecord& record = response.records.back();
  const double before = reply.recoil->velocity;
  reply.recoil->velocity -= impulse * reply.recoil->mobility;
  const double work = -impulse * 0.5 * (before + reply.recoil->velocity);
  record.energy.kinetic += work;
  struck_[side.body] += work;
  if (reply.recoil->mobility > 0.0) record.momentum[0] -= impulse * port(side).geometry.normals[0];
}

void Bodies::see_recoil(int body, double time) {
  Advance nothing;
  nothing.window = {0, time, time};
  nothing.boundary.assign(describe(body).ports.size(), {});
  Response now;
  subdomains_[index(body)]->save();
  ++exchanges_;
  const Outcome outcome = (*this)[body].advance(nothing, now);
  (*this)[body].restore();
  if (!std::holds_alternative<Advanced>(outcome)) return;
  for (std::size_t p = 0; p < now.ports.size(); ++p)
    response(body).ports[p].recoil = now.ports[p].recoil;
}

void Bodies::strike_energy(const Side& side, double earlier, double impulse) {
  Response& response = responses_[side.body];
  const std::optional<Recoil>& recoil = response.ports[side.port].recoil;
  if (!recoil) return;
  const double velocity = recoil->velocity - (earlier + 0.5 * impulse) * recoil->mobility;
  response.records.back().energy.kinetic -= impulse * velocity;
  struck_[side.body] -= impulse * velocity;
}

PortKernel& Bodies::cached(Kernels& kernels, int body, int port) {
  auto same = [body, port](const CachedKernel& k) { return k.body == body && k.port == port; };
  const auto found = std::ranges::find_if(kernels, same);
  if (found != kernels.end()) return found->kernel;
  return kernels.emplace_back(CachedKernel{body, port, {}}).kernel;
}

double Bodies::step(int body) const {
  const double own = describe(body).step, window = request(body).window.length();
  const double whole = own > 0.0 ? own : window_;
  return window > 0.0 && window < (1.0 - remainder) * whole ? window : whole;
}

PortKernel Bodies::ask(int body, double step, Probing probing) {
  probing.step = step;
  ++exchanges_;
  return (*this)[body].probe(probing);
}

PortKernel Bodies::probe(int body, int port, std::span<const double> patterns, int count,
                         std::span<const int> seen) {
  Probing probing{port, {patterns.begin(), patterns.end()}, 0.0, count};
  if (seen.size() != 1 || seen.front() != port) probing.seen.assign(seen.begin(), seen.end());
  return ask(body, step(body), std::move(probing));
}

const PortKernel& Bodies::kernel(int body, int port, int count) {
  PortKernel& kernel = cached(kernels_, body, port);
  if (kernel.count() >= count) return kernel;
  const PortGeometry& surface = describe(body).ports[port].geometry;
  const double own = describe(body).step;
  kernel =
      along(ask(body, own > 0.0 ? own : window_, {port, surface.normals, 0.0, count}), surface);
  return kernel;
}

PortKernel Bodies::full_kernel(int body, int port, int count,
                               const std::vector<std::int32_t>& points) {
  const PortGeometry& surface = describe(body).ports[port].geometry;
  const std::size_t width = surface.points.size(), dim = index(surface.dim);
  const std::size_t values = points.empty() ? width : points.size() * dim;
  const double each = 2.0 * sizeof(double) * count * static_cast<double>(width);
  const std::size_t at_once =
      std::clamp<std::size_t>(static_cast<std::size_t>(probe_bytes / each), 1, values);
  PortKernel whole;
  std::vector<double> units;
  for (std::size_t first = 0; first < values; first += at_once) {
    const std::size_t some = std::min(at_once, values - first);
    units.assign(some * width, 0.0);
    for (std::size_t k = 0; k < some; ++k) {
      const std::size_t v = first + k;
      units[k * width + (points.empty() ? v : index(points[v / dim]) * dim + v % dim)] = 1.0;
    }
    PortKernel part =
        for_levels(cut(ask(body, step(body), {port, units, 0.0, count}), points, dim));
    if (some == values) return part;
    if (first == 0) whole = room_for(part, static_cast<int>(values));
    put(part, static_cast<int>(first), whole);
  }
  return whole;
}

void Bodies::meet(const Side& kinematic, int partner, const Side& of, const PortKernel& kernel) {
  try {
    (*this)[kinematic.body].meet({kinematic.port, partner, nullptr, {}, &kernel});
  } catch (const RunError& error) {
    throw RunError(fmt::format("{} (body '{}', told how body '{}' gives way)", error.what_is_wrong,
                               describe(kinematic.body).name, describe(of.body).name),
                   error.where, error.remedy);
  }
}

std::vector<double> Bodies::impulse_response(const Side& side, const TimeWindow& window) {
  const Description& body = describe(side.body);
  const double normal = port(side).geometry.normals[0];
  const double impulse = body.mass;  // [N s] that changes the velocity of the whole by 1 m/s
  std::array<Response, 2> responses;
  Advance alone;
  alone.window = window;
  for (std::size_t struck : {0u, 1u}) {
    alone.boundary.assign(body.ports.size(), {});
    if (struck == 1) alone.boundary[side.port].impulse = {-normal * impulse};
    ++exchanges_;
    const Outcome outcome = (*this)[side.body].advance(alone, responses[struck]);
    compute_seconds_[side.body] += responses[struck].compute_seconds;
    (*this)[side.body].restore();
    if (!std::holds_alternative<Advanced>(outcome)) return {};
  }
  const std::vector<double>& before = responses[0].ports[side.port].trace.u;
  const std::vector<double>& after = responses[1].ports[side.port].trace.u;
  std::vector<double> moved;
  for (std::size_t i = 1; i < std::min(before.size(), after.size()); ++i)
    moved.push_back(normal * (after[i] - before[i]) / impulse);
  return moved;
}

double Bodies::shortest_step() const {
  double shortest = window_;
  for (int b = 0; b < count(); ++b) {
    if (describe(b).step > 0.0) shortest = std::min(shortest, describe(b).step);
  }
  return shortest;
}

double Bodies::longest_step() const {
  double longest = 0.0;
  for (int b = 0; b < count(); ++b) longest = std::max(longest, describe(b).step);
  return longest > 0.0 ? longest : window_;
}

double Bodies::overhead_median() const {
  if (overhead_.empty()) return 0.0;
  std::vector<float> sorted = overhead_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return static_cast<double>(*middle);
}

void Bodies::counts(Archive& archive) { archive.field("exchanges", exchanges_); }

void Bodies::keep_reactions(std::span<const Response> earlier) {
  for (std::size_t b = 0; b < responses_.size(); ++b) {
    for (std::size_t p = 0; p < responses_[b].ports.size(); ++p) {
      std::vector<Reaction>& now = responses_[b].ports[p].reactions;
      const std::vector<Reaction>& before = earlier[b].ports[p].reactions;
      // Replies from other processes have places for reactions that there are none of.
      now.resize(std::max(now.size(), before.size()));
      for (std::size_t k = 0; k < before.size(); ++k)
        if (now[k].force.empty()) now[k] = before[k];
    }
  }
}

void Bodies::ends(Archive& archive) {
  archive.field("taken_back", taken_back_);
  archive.field("struck", struck_);
  for (Response& response : responses_) field(archive, "response", response);
}

void Bodies::state(Archive& archive) {
  ends(archive);
  for (Advance& request : requests_)  // replies have a reaction for every place
    for (BoundaryData& boundary : request.boundary)
      list(archive, "obstacles", boundary.obstacles, [](Archive&, Obstacle&) {});
  list(archive, "kernels", kernels_, [](Archive& a, CachedKernel& known) {
    whole(a, "body", known.body);
    whole(a, "port", known.port);
    field(a, "kernel", known.kernel);
  });
}

}  // namespace abut
