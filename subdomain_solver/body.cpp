#include "subdomain_solver/body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/force_means.hpp"
#include "contract/no_answer.hpp"
#include "subdomain_solver/port_forecast.hpp"
#include "subdomain_solver/port_statics.hpp"

namespace abut {

namespace {

void write(Interior& interior, std::vector<std::byte>& bytes, Archive::Form form) {
  Archive archive = Archive::writer(bytes, form);
  interior.state(archive);
  archive.finish();
}

/// Throws RunError when the fields are others (Form::named).
void read(Interior& interior, std::span<const std::byte> bytes, Archive::Form form) {
  Archive archive = Archive::reader(bytes, form);
  interior.state(archive);
  archive.finish();
}

/// A value that is not finite anywhere in a state reaches one of these sums; states that grow
/// without bound are ended before their squares leave the range of numbers.
bool finite(const BodyRecord& r) {
  constexpr double too_large = 1.0e150;
  double sum = r.energy.total() + r.energy.external_work;
  for (const std::vector<double>* told : {&r.momentum, &r.angular_momentum, &r.columns})
    sum = std::accumulate(told->begin(), told->end(), sum);
  return std::abs(sum) < too_large;
}

}  // namespace

Body::Body(std::unique_ptr<Interior> interior, std::function<void()> progress)
    : interior_(std::move(interior)), progress_(std::move(progress)) {
  std::size_t values = 0;
  for (const Port& port : describe().ports) {
    Watched& watched = ports_.emplace_back();
    watched.geometry = &port.geometry;
    watched.first = values;
    watched.width = port.geometry.points.size();
    values += watched.width;
    watched.lower.resize(index(port.geometry.dim));
    watched.upper.resize(index(port.geometry.dim));
  }
  partners_.resize(ports_.size());
  neighbours_.resize(ports_.size());
  step_effort_ = interior_->traits().effort;
}

void Body::meet(const Meeting& meeting) {
  std::deque<Partner>& partners = partners_.at(index(meeting.port));
  const std::string partner_of = fmt::format("a partner of body '{}'", describe().name);
  if (meeting.surface != nullptr) {
    if (meeting.partner != static_cast<int>(partners.size()))
      throw RunError(
          fmt::format("is number {}, where {} is next", meeting.partner, partners.size()),
          partner_of, "Number the partners of a port in the order of their surfaces.");
    partners.push_back({*meeting.surface, meeting.law, {}});
  }
  if (meeting.kernel == nullptr) return;
  const Obstructed* obstructed = interior_->able().obstructed;
  const std::string misfit =
      obstructed != nullptr ? obstructed->misfit(meeting.port, *meeting.kernel) : "it takes none";
  if (!misfit.empty()) {
    throw RunError("gives way by a kernel that this body cannot take: " + misfit, partner_of,
                   "Let obstacles give way only with kernels of this body's step and support.");
  }
  if (meeting.partner == own_surface) {
    neighbours_.at(index(meeting.port)) = *meeting.kernel;
  } else {
    partners.at(index(meeting.partner)).kernel = *meeting.kernel;
  }
}

void Body::save() { write(*interior_, saved_, Archive::Form::bare); }

void Body::restore() {
  read(*interior_, saved_, Archive::Form::bare);
  interior_->restored();
}

std::vector<std::byte> Body::checkpoint() {
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::named);
  std::string scheme = interior_->traits().scheme;
  bool statics = describe().quasi_static;
  std::string basis = interior_->traits().basis;
  archive.field("scheme", scheme);
  archive.field("statics", statics);
  archive.field("basis", basis);
  interior_->state(archive);
  archive.finish();
  return bytes;
}

void Body::resume(std::span<const std::byte> bytes) {
  const std::size_t own = interior_->coordinates();
  std::vector<std::byte> before;
  write(*interior_, before, Archive::Form::bare);
  try {
    read_checkpoint(bytes);
    if (interior_->coordinates() != own) {
      throw RunError(fmt::format("the checkpoint holds {} coordinates, but the body has {}",
                                 interior_->coordinates(), own),
                     fmt::format("body '{}'", describe().name),
                     "Resume with the mesh that wrote the checkpoint.");
    }
  } catch (...) {
    read(*interior_, before, Archive::Form::bare);
    throw;
  }
  interior_->restored();
}

/// That of a body without a state is 0.
std::uint64_t Body::state_hash() {
  return interior_->coordinates() == 0 ? 0 : hash_state(*interior_);
}

Outcome Body::finish(Response& response) {
  ABUT_ASSERT(request_ != nullptr);
  const Advance& request = *std::exchange(request_, nullptr);
  const auto began = std::chrono::steady_clock::now();
  const Window window = window_of(request, divide(request));
  begin_replies(request, response);
  recorded_ = 0;
  if (std::optional<Failed> failed = advance(window, response)) return *failed;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    list_reactions(p);
    interior_->finish(p, response.ports[p]);
  }
  if (request.ahead > 0.0) look_ahead(request, response);
  response.steps = window.grid.count;
  response.compute_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return Advanced{};
}

/// The window loop of all bodies.
std::optional<Failed> Body::advance(const Window& window, Response& response) {
  const Substeps& grid = window.grid;
  if (auto failed = patiently([&] { return interior_->begin(window); })) return failed;
  follow(window, 0, grid.begin, true);
  interior_->set_off(window);
  begin_sweep();
  RecordClock clock(window.request, grid.count);
  const PortStatics* statics = interior_->able().statics;
  for (int i = 1; i <= grid.count; ++i) {
    const bool due = i == clock.substep();
    if (auto failed = patiently([&] { return interior_->step(window, i, due); })) return failed;
    if (statics != nullptr)
      for (const double left : statics->unbalanced()) response.unbalanced.push_back(left);
    if (window.request.sampling == Sampling::substeps) {
      follow(window, i, grid.time(i), true);
    } else {
      follow(window, i, due ? clock.time() : grid.time(i), due);
    }
    report_progress();
    for (; i == clock.substep(); clock.next())
      if (auto failed = record(clock.time(), response)) return failed;
  }
  for (; !clock.done(); clock.next())  // a window of no length
    if (auto failed = record(clock.time(), response)) return failed;
  return std::nullopt;
}

/// From where the body is through a request that leaves no records; `visit` is called with the
/// number of every substep behind it, from 0.
template <class Visit>
std::optional<Failed> Body::walk(const Window& window, const Visit& visit) {
  if (auto failed = patiently([&] { return interior_->begin(window); })) return failed;
  visit(0);
  interior_->set_off(window);
  for (int i = 1; i <= window.grid.count; ++i) {
    if (auto failed = patiently([&] { return interior_->step(window, i, false); })) return failed;
    report_progress();
    visit(i);
  }
  return std::nullopt;
}

/// What partners press with at the window's end is gone by the end of the next substep. A look that
/// fails has nothing to tell.
void Body::look_ahead(const Advance& request, Response& response) {
  if (!interior_->traits().looks_ahead) return;
  for (std::size_t p = 0; p < ports_.size(); ++p)
    if (request.boundary[p].obstructed() && ports_[p].width > 1) return;
  const double begin = request.window.end;
  ahead_.window = {request.window.index + 1, begin, begin + request.ahead};
  ahead_.boundary.resize(ports_.size());
  const Substeps grid = divide(ahead_);
  for (std::size_t p = 0; p < ports_.size(); ++p)
    release(p, request, grid, response.ports[p].trace);
  const Window window = window_of(ahead_, grid);
  const auto tell = [&](double time, const std::vector<double>& u) {
    for (std::size_t p = 0; p < ports_.size(); ++p) {
      Waveform& told = response.ports[p].ahead;
      told.width = static_cast<int>(ports_[p].width);
      told.time.push_back(time);
      const auto from = u.begin() + static_cast<std::ptrdiff_t>(ports_[p].first);
      told.u.insert(told.u.end(), from, from + static_cast<std::ptrdiff_t>(ports_[p].width));
    }
  };
  const auto values = static_cast<std::ptrdiff_t>(ports_.back().first + ports_.back().width);
  PortForecast* forecast = interior_->able().forecast;
  if (forecast != nullptr && forecast->tell(window, peeked_)) {
    tell(grid.begin, interior_->see(window, grid.begin, false).u);
    for (int i = 1; i <= grid.count; ++i) {
      const auto from = peeked_.begin() + (i - 1) * values;
      tell(grid.time(i), {from, from + values});
    }
    return;
  }
  write(*interior_, looked_, Archive::Form::bare);
  const std::optional<Failed> failed = walk(window, [&](int i) {
    const double time = i == 0 ? grid.begin : grid.time(i);
    tell(time, interior_->see(window, time, false).u);
  });
  for (PortResponse& port : response.ports)
    if (failed) port.ahead.clear();
  read(*interior_, looked_, Archive::Form::bare);
  interior_->restored();
}

/// The forces that a request ends with on a port, and none from the end of the next step on of
/// those who gave them; those that are constant in steps end with the request. At a point that
/// found contact itself that is its own.
void Body::release(std::size_t p, const Advance& request, const Substeps& grid,
                   const Waveform& trace) {
  const std::size_t width = ports_[p].width, dim = index(ports_[p].geometry->dim);
  std::vector<Waveform>& forces = ahead_.boundary[p].forces;
  forces.resize(1);
  Waveform& gone = forces[0];
  gone.clear();
  const bool obstructed = request.boundary[p].obstructed();
  if (width == 1) return release_point(request, obstructed ? &trace : nullptr, p, gone);
  if (!request.boundary[p].pushed()) return;
  gone.width = static_cast<int>(width);
  gone.support = ForceSupport::linear;
  gone.time = levels_of(grid);
  gone.f.assign(gone.time.size() * width, 0.0);
  for (const Waveform& force : request.boundary[p].forces) {
    if (force.empty() || force.support == ForceSupport::step) continue;
    pressing_.resize(index(force.width));
    force.force_at(request.window.end, pressing_);
    for (std::size_t k = 0; k < pressing_.size(); ++k) {
      const bool listed = !force.points.empty();
      gone.f[listed ? index(force.points[k / dim]) * dim + k % dim : k] += pressing_[k];
    }
  }
}

/// The same of one value: it acts over the dual cell of the window's end (nodal), or not any more.
void Body::release_point(const Advance& request, const Waveform* own, std::size_t p,
                         Waveform& gone) const {
  const std::vector<Waveform>& forces = request.boundary[p].forces;
  const auto given = std::ranges::find_if(forces, [](const Waveform& f) { return !f.empty(); });
  const Waveform* last = own != nullptr ? own : given != forces.end() ? &*given : nullptr;
  if (last == nullptr || last->support == ForceSupport::step || last->size() < 2) return;
  const TimeWindow& next = ahead_.window;
  const Substeps grid = Substeps::divide(next.begin, next.end, last->time[1] - last->time[0]);
  gone.width = 1;
  gone.support = last->support;
  gone.time = levels_of(grid);
  gone.f.assign(gone.time.size(), 0.0);
  if (own != nullptr) gone.f[0] = own->f.back();
  for (const Waveform& force : forces)
    if (own == nullptr && !force.empty()) gone.f[0] += force.f.back();
}

/// A body without a step of its own goes from record to record.
Substeps Body::divide(const Advance& request) const {
  const TimeWindow& window = request.window;
  const std::int64_t records = std::max<std::int64_t>(1, request.records / window.windows);
  return Substeps::divide(window, describe().step, static_cast<int>(records));
}

void Body::follow(const Window& window, int substep, double time, bool shown) {
  seen_ = &interior_->see(window, time, shown);
  widen_sweep();
  widen_velocities(substep > 0 ? window.grid.length(substep) : 0.0);
  if (!shown) return;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    push_trace(ports_[p], time);
    if (!ports_[p].reply->reactions.empty()) push_reactions(p, time);
  }
}

std::optional<Failed> Body::record(double time, Response& response) {
  for (const Watched& port : ports_) {
    PortResponse& reply = *port.reply;
    reply.lower.insert(reply.lower.end(), port.lower.begin(), port.lower.end());
    reply.upper.insert(reply.upper.end(), port.upper.begin(), port.upper.end());
  }
  begin_sweep();
  return tell(response.records[recorded_++], time);
}

std::optional<Failed> Body::tell(BodyRecord& r, double time) {
  r.time = time;
  if (std::optional<Failed> failed = interior_->record(r)) return failed;
  if (finite(r)) return std::nullopt;
  return Failed{
      Failed::Cause::non_finite, time,
      fmt::format("the state of body '{}' is no longer finite; its step of {:g} s may be unstable "
                  "or a value out of range: give a smaller step, check the scene's values",
                  describe().name, describe().step)};
}

PortKernel Body::probe(const Probing& asked) {
  Probed* probed = interior_->able().probed;
  if (!describe().can.kernel || probed == nullptr) {
    throw RunError("does not answer for port kernels", fmt::format("body '{}'", describe().name),
                   "Ask bodies for kernels only when they offer them.");
  }
  const int own[] = {asked.port};
  const std::span<const int> seen = asked.seen.empty() ? std::span<const int>(own) : asked.seen;
  const bool joined = interior_->support(index(asked.port)) == ForceSupport::step;
  const bool statics = describe().quasi_static && (joined || !describe().loose.empty());
  PortKernel kernel = statics ? probe_statics(asked, seen) : probe_dynamics(asked, seen);
  const double compliance = asked.seen.empty() ? probed->compliance(index(asked.port)) : 0.0;
  if (compliance > 0.0)
    for (const double value : asked.patterns) kernel.compliance.push_back(compliance * value);
  return kernel;
}

PortKernel Body::probe_dynamics(const Probing& asked, std::span<const int> seen) {
  const auto& [port, patterns, step, count, only] = asked;
  Probed* probed = interior_->able().probed;
  const std::size_t p = index(port), width = describe().ports.at(p).geometry.points.size();
  ABUT_ASSERT(step > 0.0 && patterns.size() % width == 0);
  std::vector<std::byte> kept;
  write(*interior_, kept, Archive::Form::bare);
  const Substeps grid{0.0, count * step, step, step, count};
  PortKernel kernel;
  kernel.step = step;
  kernel.support = interior_->support(p);
  kernel.patterns = static_cast<int>(patterns.size() / width);
  kernel.width = 0;
  for (const int s : seen)
    kernel.width += static_cast<int>(describe().ports.at(index(s)).geometry.points.size());
  kernel.displacement.assign(index(count) * kernel.per_step(), 0.0);
  const bool nodal = only.empty() && kernel.support == ForceSupport::nodal;
  if (nodal) kernel.begin = kernel.displacement;
  // Surfaces without mass, and with inertia behind them; of a point it is asked for.
  const bool leans = width > 1 && describe().can.obstacle && !describe().quasi_static;
  Advance request;
  request.window = {0, grid.begin, grid.end};
  request.boundary.resize(ports_.size());
  Waveform& force = request.boundary[p].forces.emplace_back(static_cast<int>(width));
  force.support = kernel.support;
  for (int i = 0; i <= count; ++i) force.time.push_back(i == 0 ? grid.begin : grid.time(i));
  const double light = probed->light_force(p);
  const std::size_t values = index(kernel.width);
  std::vector<double> alone, moved;
  std::optional<Failed> failed;
  force.f.assign(force.time.size() * width, 0.0);
  if (probed->rest(p)) failed = respond(request, grid, seen, alone);
  alone.resize(index(count) * values, 0.0);
  for (std::size_t k = 0; k < index(kernel.patterns) && !failed; ++k) {
    for (const std::size_t at : {0u, 1u}) {  // at the begin, at the end of the first substep
      if (at == 0 && !nodal) continue;
      std::vector<double>& to = at == 0 ? kernel.begin : kernel.displacement;
      force.f.assign(force.time.size() * width, 0.0);
      for (std::size_t i = 0; i < width; ++i)
        force.f[at * width + i] = light * patterns[k * width + i];
      probed->rest(p);
      failed = respond(request, grid, seen, moved);
      for (std::size_t i = 0; at == 0 && leans && i < at_begin_.size(); ++i)
        kernel.compliance.push_back(at_begin_[i] / light);
      for (std::size_t i = 0; i < moved.size(); ++i)
        to[i / values * kernel.per_step() + k * values + i % values] =
            (moved[i] - alone[i]) / light;
    }
  }
  probed->wake();
  read(*interior_, kept, Archive::Form::bare);
  interior_->restored();
  if (!failed) return kernel;
  throw NoAnswer(*failed, describe().name);
}

/// What has no inertia answers at once, and forgets.
PortKernel Body::probe_statics(const Probing& asked, std::span<const int> seen) {
  const auto& [port, patterns, step, count, only] = asked;
  const Watched& pressed = ports_[port];
  PortKernel kernel;
  kernel.step = step;
  kernel.support = interior_->support(index(port));
  kernel.patterns = static_cast<int>(patterns.size() / pressed.width);
  kernel.width = 0;
  for (const int s : seen) kernel.width += static_cast<int>(ports_[s].width);
  std::vector<double> force(ports_.back().first + ports_.back().width, 0.0), moved;
  Eigen::VectorXd place = Eigen::VectorXd::Zero(loose_motions(describe())), left;
  const auto see = [&](std::vector<double>& to) {
    if (!interior_->able().statics->give(force, place, moved, left))
      throw NoAnswer({Failed::Cause::no_convergence, 0.0, "its stiffness is singular"},
                     describe().name);
    for (const int s : seen) {
      const auto from = moved.begin() + static_cast<std::ptrdiff_t>(ports_[s].first);
      to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(ports_[s].width));
    }
  };
  for (std::size_t k = 0; k < index(kernel.patterns); ++k) {
    std::ranges::copy(std::span(patterns).subspan(k * pressed.width, pressed.width),
                      force.begin() + static_cast<std::ptrdiff_t>(pressed.first));
    see(kernel.displacement);
  }
  kernel.displacement.resize(index(count) * kernel.per_step(), 0.0);
  if (kernel.support == ForceSupport::nodal) kernel.begin.resize(kernel.displacement.size(), 0.0);
  std::ranges::fill(force, 0.0);
  for (Eigen::Index k = 0; k < place.size(); ++k) {
    place.setUnit(k);
    see(kernel.carried);
    kernel.left.insert(kernel.left.end(), left.begin(), left.end());
  }
  return kernel;
}

/// Displacements (substeps, values) of ports, one after the other, under the forces of a request
/// [m].
std::optional<Failed> Body::respond(const Advance& request, const Substeps& grid,
                                    std::span<const int> ports, std::vector<double>& displacement) {
  const Window window = window_of(request, grid);
  displacement.clear();
  at_begin_.clear();
  return walk(window, [&](int i) {
    std::vector<double>& to = i == 0 ? at_begin_ : displacement;
    const double time = i == 0 ? grid.begin : grid.time(i);
    const std::vector<double>& u = interior_->see(window, time, false).u;
    for (const int port : ports) {
      const auto from = u.begin() + static_cast<std::ptrdiff_t>(ports_[port].first);
      to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(ports_[port].width));
    }
  });
}

void Body::report_progress() {
  effort_ += step_effort_;
  if (effort_ < 1.0) return;
  effort_ = 0.0;
  if (progress_) progress_();
}

}  // namespace abut
