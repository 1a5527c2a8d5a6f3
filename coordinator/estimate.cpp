#include "coordinator/estimate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/count.hpp"
#include "coordinator/coupling/kernel_bytes.hpp"
#include "coordinator/coupling/steps.hpp"
#include "coordinator/flight_work.hpp"
#include "coordinator/solver_processes.hpp"

namespace abut {

namespace {

constexpr double mebi = 1048576.0;
constexpr double process_mib = 9.5;        // libraries and sockets of a solver process, measured
constexpr double bytes_per_dof = 200.0;    // state, saved state, matrices and scratch of a bar
constexpr double bytes_factored = 3500.0;  // the same of an implicit solid and its factors, at 2e4
constexpr std::int64_t flights = 8;        // requests of free flight to and from one contact
// Most iterations in a window on average, as measured over the shipped scenes: of linear bodies
// with port kernels (2.3, and a guess of N), of others (3.5), of the published form (12.5).
constexpr std::int64_t sweeps_linear = 3, sweeps_nonlinear = 5, sweeps_published = 15;
constexpr std::int64_t many_rows = 500;  // found row by row beyond
constexpr std::int64_t per_event = 3;    // attempts and the window cut at an event
// Into how many windows a scene's one is cut where ends of bars bounce all the time (4.6 measured).
constexpr std::int64_t cuts_of_bouncing = 5;

void list_features(const Scene& scene, Estimate& e) {
  auto feature = [&e](bool used, const char* name) {
    (used ? e.in_use : e.not_built).emplace_back(name);
  };
  bool unilateral = false, published = false, internal = false, connected = false, tied = false;
  for (const auto& [name, interface] : scene.interfaces) {
    const auto& how = interface.transmission;
    unilateral = unilateral || std::holds_alternative<UnilateralTransmission>(how);
    published = published || is_published(how);
    internal = internal || is_inside(how);
    tied = tied || interface.tied.has_value();
  }
  for (const auto& [name, body] : scene.bodies) {
    connected = connected || may_run_elsewhere(body);
  }
  unilateral = unilateral || scene.everything() != nullptr;
  const bool coupled = unilateral || published;
  feature(unilateral, "unilateral transmission");
  feature(published, "published Dirichlet-Neumann form");
  feature(internal, "contact inside a body");
  feature(tied, "tied interfaces");
  feature(scene.everything() != nullptr, "contact between everything");
  feature(coupled && scene.schwarz.parallel, "parallel form");
  feature(coupled && std::holds_alternative<KernelAcceleration>(scene.schwarz.accelerator),
          "port kernels");
  feature(coupled && !std::holds_alternative<KernelAcceleration>(scene.schwarz.accelerator) &&
              !std::holds_alternative<NoAcceleration>(scene.schwarz.accelerator),
          "relaxation or secants alone");
  feature(scene.schwarz.on_nonconvergence == OnNonconvergence::halve, "halving of windows");
  feature(scene.meta.closed_form.has_value(), "closed form");
  feature(connected, "network");
}

/// Contact inside bodies alone: nothing is iterated, and nothing flies free.
bool watched_only(const Scene& scene) {
  return !scene.interfaces.empty() &&
         std::all_of(scene.interfaces.begin(), scene.interfaces.end(),
                     [](const auto& entry) { return is_inside(entry.second.transmission); });
}

double memory_mib(const Description& body) {
  const bool factored = body.dim > 1 && std::isinf(body.stable_step);
  const double bytes = factored ? bytes_factored : bytes_per_dof;
  return process_mib + static_cast<double>(body.dofs) * bytes / mebi;
}

/// How the surface of a side would give way to the other; points: 0: it would not.
Estimate::Kernel kernel_of(const InterfaceSpec& spec, const UnilateralTransmission& how,
                           std::size_t side, double window,
                           std::span<const Description* const> bodies) {
  Estimate::Kernel kernel;
  kernel.interface = spec.name;
  kernel.side = spec.sides[side];
  if (how.kinematic == kernel.side) return kernel;
  const auto body_of = [bodies](const std::string& text) -> const Description* {
    const std::string name(split_port(text).body);
    const auto at = std::ranges::find_if(
        bodies, [&name](const Description* b) { return b != nullptr && b->name == name; });
    return at == bodies.end() ? nullptr : *at;
  };
  const Description* body = body_of(kernel.side);
  const Description* finder = body_of(spec.sides[1 - side]);
  if (body == nullptr || finder == nullptr || body->dim == 1 || !body->can.kernel ||
      std::isinf(body->mass) || !finder->can.yielding)
    return kernel;
  const auto points_of = [](const Description& of, const std::string& text) {
    const std::string port(split_port(text).port);
    for (const Port& p : of.ports)
      if (p.name == port) return static_cast<std::int64_t>(p.geometry.count());
    return std::int64_t{0};
  };
  kernel.points = points_of(*body, kernel.side);
  const std::int64_t rows = points_of(*finder, spec.sides[1 - side]);
  if (rows > many_rows && finder->can.bands)
    kernel.rows_mib =
        near_rows_bytes(static_cast<double>(rows), body->dim, spec.contact->friction.rubs()) / mebi;
  kernel.substeps = body->step > 0.0
                        ? count_within(std::ceil(window / body->step - 1.0e-9), 1, 1'000'000'000)
                        : 1;
  kernel.allowed_mib = how.kernel_memory.value_or(usual_kernel_memory);
  const double steps = static_cast<double>(kernel.substeps);
  kernel.memory_mib = kernel_bytes(static_cast<double>(kernel.points) * body->dim, steps) / mebi;
  double fit = std::sqrt(kernel.allowed_mib * mebi / kernel_bytes(1.0, steps)) / body->dim;
  if (finder->can.bands && !body->quasi_static && kernel.memory_mib * mebi > always_full_kernel) {
    const double points = static_cast<double>(kernel.points);
    kernel.banded_mib = banded_kernel_bytes(points, body->dim, steps) / mebi;
    fit = std::max(fit, points * kernel.allowed_mib / kernel.banded_mib);
  }
  kernel.points_that_fit = std::min(kernel.points, static_cast<std::int64_t>(std::min(fit, 1.0e9)));
  return kernel;
}

std::vector<Estimate::Kernel> kernels_of(const Scene& scene,
                                         std::span<const Description* const> bodies) {
  std::vector<Estimate::Kernel> kernels;
  for (const auto& [name, spec] : scene.interfaces) {
    const auto* how = std::get_if<UnilateralTransmission>(&spec.transmission);
    if (how == nullptr || !spec.contact) continue;
    Estimate::Kernel one = kernel_of(spec, *how, 0, scene.time.window, bodies);
    Estimate::Kernel other = kernel_of(spec, *how, 1, scene.time.window, bodies);
    Estimate::Kernel& larger = other.memory_mib > one.memory_mib ? other : one;
    if (larger.points > 0) kernels.push_back(std::move(larger));
  }
  return kernels;
}

/// Iterations of a window in contact, at most.
std::int64_t most_sweeps(const Scene& scene, std::span<const Description* const> known) {
  const bool published =
      std::any_of(scene.interfaces.begin(), scene.interfaces.end(),
                  [](const auto& entry) { return is_published(entry.second.transmission); });
  const bool linear = std::ranges::all_of(
      known, [](const Description* body) { return body->linear || std::isinf(body->mass); });
  const bool kernels = std::holds_alternative<KernelAcceleration>(scene.schwarz.accelerator);
  const std::int64_t sweeps = published           ? sweeps_published
                              : linear && kernels ? sweeps_linear
                                                  : sweeps_nonlinear;
  return std::min<std::int64_t>(sweeps, scene.schwarz.max_iterations.value_or(Steps::usual_most));
}

/// Whether windows are cut where ends of bars meet and part.
bool cuts_windows(const Scene& scene, std::span<const Description* const> known) {
  const bool bars =
      std::ranges::any_of(known, [](const Description* body) { return body->dim == 1; });
  return bars && std::any_of(scene.interfaces.begin(), scene.interfaces.end(),
                             [](const auto& entry) { return entry.second.contact.has_value(); });
}

/// Far above what a scene may hold (coordinator/scene.cpp), and far below the end of the type.
std::int64_t count_of(double value) {
  constexpr std::int64_t most = 1'000'000'000'000;
  return count_within(value, std::int64_t{0}, most);
}

/// Of surfaces that may touch: ends of bars that do are few, and known.
std::string why_not_passive(const Scene& scene, std::span<const Description* const> known) {
  const auto is_contact = [](const auto& entry) { return !entry.second.tied; };
  const bool touch = scene.everything() != nullptr ||
                     std::any_of(scene.interfaces.begin(), scene.interfaces.end(), is_contact);
  const bool wants = scene.schwarz.on_nonconvergence == OnNonconvergence::passive;
  if (!touch || !wants || known.empty() || known.front()->dim == 1) return {};
  for (const auto& [name, interface] : scene.interfaces)
    if (interface.tied && (interface.tied->overlap || is_dashpot(interface.transmission)))
      return fmt::format("bodies that '{}' {} have no passive form", name,
                         interface.tied->overlap ? "lets overlap" : "joins by dashpots");
  for (const Description* body : known)
    if (!body->can.passive) return fmt::format("body '{}' has no passive form", body->name);
  return {};
}

}  // namespace

Estimate estimate(const Scene& scene, std::span<const Description* const> bodies,
                  std::optional<double> contact_time) {
  Estimate e;
  const double span = scene.time.end - scene.time.begin;
  e.windows = count_of(std::ceil(span / scene.time.window - 1.0e-9));
  std::vector<const Description*> known;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Description* body = bodies[b];
    if (body == nullptr) {
      e.bodies.push_back({scene.bodies[b].first, "external", false});
      continue;
    }
    const double steps = body->step > 0.0 ? span / body->step : static_cast<double>(e.windows);
    e.bodies.push_back(
        {body->name, body->model, true, body->dofs, count_of(steps), memory_mib(*body)});
    known.push_back(body);
  }
  e.not_passive = why_not_passive(scene, known);
  const std::int64_t count = static_cast<std::int64_t>(bodies.size());
  std::int64_t joints = static_cast<std::int64_t>(scene.interfaces.size());
  if (scene.everything() != nullptr) joints += count;  // pairs that touch, about
  const bool tied = std::any_of(scene.interfaces.begin(), scene.interfaces.end(),
                                [](const auto& entry) { return entry.second.tied.has_value(); });
  if (tied) {
    e.contact_windows_low = e.contact_windows_high = e.windows;
  } else if (contact_time) {
    const double windows = std::min(*contact_time, span) / scene.time.window;
    e.contact_windows_low = e.contact_windows_high = count_of(windows);
  } else if (joints > 0) {
    e.contact_windows_high = e.windows;
  }
  const std::int64_t start = count + (joints > 0 && e.contact_windows_high > 0 ? 2 * joints : 0);
  const std::int64_t cuts = !contact_time && cuts_windows(scene, known) ? cuts_of_bouncing : 1;
  const std::int64_t windows = cuts * e.contact_windows_high;
  // The begin, and at least one call in every window in contact; ports may need no kernel.
  e.exchanges_low = count * (1 + std::max<std::int64_t>(1, e.contact_windows_low));
  e.sweeps = most_sweeps(scene, known);
  e.exchanges_high = start + count * (flights + e.sweeps * windows + 2 * per_event * joints);
  e.exchanges_high += e.exchanges_high / 20;  // contact that lasts a little longer, chatter
  if (joints == 0) {  // the begin, and free flight as far as one request goes
    std::int64_t at_once =
        windows_at_once(scene.time.window, scene.output.records_per_window, known);
    if (const int every = scene.output.looked_at_every(); every > 0)
      at_once = std::min<std::int64_t>(at_once, every);
    e.exchanges_low = e.exchanges_high = count * (1 + (e.windows + at_once - 1) / at_once);
  }
  if (watched_only(scene)) e.exchanges_low = e.exchanges_high = count * (1 + e.windows);
  e.kernels = kernels_of(scene, bodies);
  list_features(scene, e);
  return e;
}

namespace {

std::string text_of(const Estimate::Body& body) {
  if (!body.known)
    return "external, not known before it connects; ports, steps and expectations are checked then";
  return fmt::format("{}; {} degrees of freedom, {} substeps, about {:.1f} MiB in a process",
                     body.model, body.dofs, body.substeps, body.memory_mib);
}

/// One line per body; many equal ones that follow each other, as copies do, share one.
std::string text_of(const std::vector<Estimate::Body>& bodies) {
  constexpr std::size_t many = 4;
  std::string text;
  for (std::size_t first = 0, last = 0; first < bodies.size(); first = last + 1) {
    const std::string words = text_of(bodies[first]);
    for (last = first; last + 1 < bodies.size() && text_of(bodies[last + 1]) == words;) ++last;
    if (last - first + 1 < many) last = first;
    text += last == first ? fmt::format("  {}: {}\n", bodies[first].name, words)
                          : fmt::format("  {} to {}, each of {}: {}\n", bodies[first].name,
                                        bodies[last].name, last - first + 1, words);
  }
  return text;
}

std::string calls_of(const Estimate::Ties& ties) {
  const auto [low, high] = ties.calls();
  const std::string words =
      !high          ? fmt::format("{} calls of the bodies in a window and more", low)
      : *high == low ? fmt::format("{} call of the bodies in a window", low)
                     : fmt::format("{} to {} calls of the bodies in a window", low, *high);
  if (!ties.used) return "no kernel: " + words + ", if they converge";
  if (ties.narrow) return words;
  return words + (ties.floats    ? ", the fewest where loads go on as they went"
                  : ties.touched ? ", the most while something touches them"
                  : ties.linear  ? ""
                                 : ", more where they deform much");
}

std::string text_of(const Estimate::Ties& ties) {
  std::string text;
  for (const Estimate::Ties::Joint& joint : ties.joints)
    text += fmt::format("  {:<10} {} rows, whose force is constant in the steps of {}, {:g} s\n",
                        joint.interface, joint.rows, joint.force, joint.step);
  if (!ties.used) return text + fmt::format("  {:<10} {}\n", "", calls_of(ties));
  return text + fmt::format("  {:<10} kernel of {} on {}: {:.3g} MiB, {} probes; {}\n", "",
                            ties.joints.size() > 1 ? "their rows" : "its rows",
                            ties.banded ? "near rows" : "all rows", ties.memory_mib, ties.probes,
                            calls_of(ties));
}

}  // namespace

std::string to_text(const Estimate& e, bool verbose) {
  std::string text = text_of(e.bodies);
  const auto range = [](std::int64_t low, std::int64_t high) {
    return low == high ? fmt::format("about {}", low) : fmt::format("{} to {}", low, high);
  };
  text += fmt::format("  windows    {}, in contact {}\n", e.windows,
                      range(e.contact_windows_low, e.contact_windows_high));
  text += fmt::format("  exchanges  {}\n", range(e.exchanges_low, e.exchanges_high));
  for (const Estimate::Kernel& k : e.kernels) {
    text += fmt::format(
        "  {:<10} port kernel of {}: {:.3g} MiB where all {} points give way over {} substeps",
        k.interface, k.side, k.memory_mib, k.points, k.substeps);
    if (k.banded_mib > 0.0)
      text += fmt::format("; {:.3g} MiB and more where near points alone do", k.banded_mib);
    if (k.points_that_fit < k.points) {
      text += fmt::format(
          "; {} points fit kernel_memory, {:g} MiB: where more come near a contact, it takes more "
          "iterations",
          k.points_that_fit, k.allowed_mib);
    }
    text += '\n';
    if (k.rows_mib > 0.0)
      text += fmt::format("  {:<10} forces of many points, row by row: about {:.3g} MiB\n",
                          k.interface, k.rows_mib);
  }
  for (const Estimate::Ties& ties : e.ties) text += text_of(ties);
  if (!e.not_passive.empty())
    text += fmt::format(
        "  passively  not: {}, so a window that the accurate method cannot take ends the run\n",
        e.not_passive);
  if (!e.in_use.empty()) text += fmt::format("  in use     {}\n", fmt::join(e.in_use, ", "));
  if (verbose) text += fmt::format("  unused     {}\n", fmt::join(e.not_built, ", "));
  return text;
}

}  // namespace abut
