#include "tests/random/trial_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <exception>
#include <memory>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/yaml_document.hpp"
#include "coordinator/body_hull.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/launch.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/scene.hpp"
#include "surface/intersections.hpp"
#include "surface/skin.hpp"

namespace abut {

namespace {

/// Of energy, as issue and design set it: what is beyond is told by no rounding and no tolerance.
constexpr double most_growth = 1e-3;
/// Sums over bodies that nothing outside acts on; equations are solved to 1e-9.
constexpr double most_momentum = 1e-6;
/// Rows of facets that turn leave moments open by the gap times the force; switches to the passive
/// form keep them as far as energy lasts.
constexpr double most_angular = 1e-2;
/// Of the shortest edge: rows that hold on average let single nodes in by parts of a cell. Windows
/// are refused from 0.12 of the shortest edge of the reference, and edges shorten.
constexpr double deep = 0.15;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The outsides of all bodies, in their present state, as one skin.
class Outsides {
 public:
  /// `wholes`: by body, those with which it is one.
  Outsides(std::span<Subdomain* const> bodies, std::vector<int> wholes)
      : bodies_(bodies), wholes_(std::move(wholes)) {
    for (Subdomain* body : bodies) {
      hulls_.push_back(outside_of(*body));
      names_.push_back(body->describe().name);
    }
    std::vector<PosedSurface> surfaces;
    for (const BodyHull& hull : hulls_) surfaces.push_back(hull.surface());
    skin_ = skin_of(surfaces);
    skin_.dim = bodies_[0]->describe().dim;
    place({});
    if (skin_.dim > 1) trees_ = std::make_unique<SkinTrees>(skin_, places_);
    shortest_ = std::numeric_limits<double>::infinity();
    const auto see = [this](std::int32_t a, std::int32_t b) {
      shortest_ = std::min(shortest_, (places_[a] - places_[b]).norm());
    };
    for (const auto& e : skin_.edges) see(e[0], e[1]);
    if (skin_.dim == 2)
      for (const auto& f : skin_.facets) see(f[0], f[1]);
  }

  /// Adds pairs that cross and did not before.
  void look(double time, std::span<const Response> responses, std::vector<std::string>& out) {
    place(responses);
    if (trees_ == nullptr) return;  // of bars, which the run looks after itself
    std::vector<Intersection> found;
    intersections(*trees_, places_, deep * shortest_, {}, found);
    for (const Intersection& each : found) {
      const std::int32_t point =
          skin_.dim == 2 ? skin_.facets[each.edge][0] : skin_.edges[each.edge][0];
      std::pair<int, int> pair(skin_.group[point], skin_.group[skin_.facets[each.facet][0]]);
      if (wholes_[index(pair.first)] == wholes_[index(pair.second)]) continue;
      if (pair.first > pair.second) std::swap(pair.first, pair.second);
      if (known_.insert(pair).second)
        out.push_back(fmt::format("{} and {} at {:.4g} s", names_[index(pair.first)],
                                  names_[index(pair.second)], time));
    }
  }
  bool finite() const { return finite_; }

 private:
  /// Of tools, which tell no fields: that of their port.
  static BodyHull outside_of(Subdomain& body) {
    if (!body.describe().fields.empty()) return hull_of(body.describe(), body.grid());
    const PortGeometry& port = body.describe().ports[0].geometry;
    BodyHull hull;
    hull.dim = port.dim;
    hull.reference = hull.points = port.points;
    hull.facets = port.facets;
    hull.offsets = port.offsets;
    return hull;
  }

  std::vector<double> displacement_of(std::size_t b, std::span<const Response> responses) const {
    if (responses.empty()) return {};  // nothing has begun
    const auto& infos = bodies_[b]->describe().fields;
    const auto at = std::ranges::find(infos, "displacement", &FieldInfo::name);
    if (at != infos.end()) return bodies_[b]->fields()[index(at - infos.begin())];
    const std::size_t width = hulls_[b].reference.size(), dim = index(hulls_[b].dim);
    std::vector<double> out(width, 0.0);
    if (responses[b].ports[0].trace.u.size() < dim) return out;
    // A tool that only goes may tell of one point for all.
    const std::vector<double>& u = responses[b].ports[0].trace.u;
    const std::size_t told = index(responses[b].ports[0].trace.width);
    for (std::size_t k = 0; k < width; ++k)
      out[k] = u[u.size() - told + (told == width ? k : k % dim)];
    return out;
  }

  void place(std::span<const Response> responses) {
    places_.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const std::vector<double> values = displacement_of(b, responses);
      for (const double value : values) finite_ = finite_ && std::isfinite(value);
      pose(hulls_[b], values);
      const BodyHull& hull = hulls_[b];
      for (std::size_t n = 0; n * index(hull.dim) < hull.points.size(); ++n) {
        Eigen::Vector3d x = Eigen::Vector3d::Zero();
        for (int i = 0; i < hull.dim; ++i) x(i) = hull.points[n * index(hull.dim) + index(i)];
        places_.push_back(x);
      }
    }
  }

  std::span<Subdomain* const> bodies_;
  std::vector<int> wholes_;
  std::vector<BodyHull> hulls_;
  std::vector<std::string> names_;
  Skin skin_;
  std::unique_ptr<SkinTrees> trees_;
  std::vector<Eigen::Vector3d> places_;
  std::set<std::pair<int, int>> known_;
  double shortest_ = 0.0;
  bool finite_ = true;
};

/// By body, the first of those with which it hangs together by ties.
std::vector<int> wholes_of(const Scene& scene) {
  std::vector<int> wholes(scene.bodies.size());
  std::iota(wholes.begin(), wholes.end(), 0);
  const auto number = [&scene](const std::string& side) {
    const auto at = std::ranges::find(scene.bodies, split_port(side).body,
                                      [](const auto& entry) { return entry.first; });
    return index(at - scene.bodies.begin());
  };
  for (const auto& [name, interface] : scene.interfaces) {
    if (!interface.tied) continue;
    const int one = wholes[number(interface.sides[0])], other = wholes[number(interface.sides[1])];
    for (int& of : wholes)
      if (of == one || of == other) of = std::min(one, other);
  }
  return wholes;
}

/// Watches a run from outside: balances, outsides, time.
struct Judge : Observer {
  Judge(TrialRun& of, std::span<Subdomain* const> bodies, std::vector<int> wholes, double patience)
      : run(of), outsides(bodies, std::move(wholes)), until(processor_seconds() + patience) {}

  void on_window(const WindowReport& report) override {
    const std::size_t records = report.responses[0].records.size();
    for (std::size_t r = 0; r < records; ++r) see(report.responses, r);
    time = report.window.end;
    outsides.look(time, report.responses, run.crossings);
    if (processor_seconds() > until) stop = true;
  }
  void on_end(const RunEnd& end) override {
    run.status = end.status;
    run.reason = end.reason;
    for (const Overlap& overlap : end.overlaps)
      run.overlaps.push_back(fmt::format("bodies {} and {} by {:.2g} m at {:.4g} s",
                                         overlap.body[0], overlap.body[1], overlap.depth,
                                         overlap.time));
    if (run.scale > 0.0)  // no body tells of them; what is owed is not lost
      run.loss -= (end.given_up.friction + end.given_up.impacts + end.given_up.owed) / run.scale;
    run.passive = end.windows > 0 ? double(end.given_up.windows) / double(end.windows) : 0.0;
    run.hashes = end.body_hashes;
  }

  void see(std::span<const Response> responses, std::size_t r) {
    double energy = 0.0, account = 0.0, sizes = 0.0;
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
    double moments = 0.0;
    run.momenta.clear();
    for (const Response& response : responses) {
      const BodyRecord& record = response.records[r];
      energy += record.energy.total();
      account += record.energy.total() + record.energy.dissipated - record.energy.external_work;
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < record.momentum.size(); ++i) p(int(i)) = record.momentum[i];
      run.momenta.push_back(p);
      momentum += p;
      sizes += p.norm();
      Eigen::Vector3d l = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < record.angular_momentum.size(); ++i)
        l(int(i)) = record.angular_momentum[i];
      angular += l;
      moments += l.norm();
    }
    run.finite = run.finite && std::isfinite(account) && momentum.allFinite();
    if (!std::exchange(start.known, true))
      start = {.known = true, .account = account, .momentum = momentum, .angular = angular};
    run.energy = energy;
    run.scale = std::max(run.scale, energy);
    run.impulse = std::max(run.impulse, sizes);
    grown = std::max(grown, account - start.account);
    changed = std::max(changed, (momentum - start.momentum).norm());
    if (run.scale > 0.0) run.growth = grown / run.scale;
    if (run.scale > 0.0) run.loss = (start.account - account) / run.scale;
    if (run.impulse > 0.0) run.momentum = changed / run.impulse;
    most_moment = std::max(most_moment, moments);
    turned = std::max(turned, (angular - start.angular).norm());
    if (most_moment > 0.0) run.angular = turned / most_moment;
  }

  TrialRun& run;
  Outsides outsides;
  double until;
  std::atomic<bool> stop = false;
  /// What there was when the run began.
  struct Start {
    bool known = false;
    double account = 0.0;  // [J]
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  } start;
  double time = 0.0;  // [s]
  double grown = 0.0, changed = 0.0, turned = 0.0, most_moment = 0.0;
};

/// The bodies of a run and what keeps their processes alive.
struct Placed {
  std::unique_ptr<Launch> launch;  // null: this process
  std::vector<std::unique_ptr<Subdomain>> bodies;
  std::vector<Subdomain*> pointers;
};

Placed place(const Scene& scene, const Document& document, bool elsewhere) {
  Placed placed;
  if (elsewhere) {
    const Specification text{document.name(), document.text(), document.overrides_elsewhere(), ""};
    placed.launch = std::make_unique<Launch>(scene, text, LaunchOptions());
    placed.bodies = placed.launch->take_bodies();
  } else {
    placed.bodies = launch_local(scene, document);
  }
  std::vector<const Description*> descriptions;
  for (const std::unique_ptr<Subdomain>& body : placed.bodies) {
    placed.pointers.push_back(body.get());
    descriptions.push_back(&body->describe());
  }
  validate_bodies(scene, descriptions, document);
  return placed;
}

/// The state of a run between two windows.
struct Kept {
  std::vector<std::byte> run;
  std::vector<std::vector<std::byte>> bodies;
  Judge::Start start;
  double scale = 0.0, impulse = 0.0;  // [J], [N s] most so far
};

/// That of the middle of a run, which goes on to its end. None where one window leads there.
Kept keep_middle(const Scene& scene, const Document& document, double patience) {
  const Placed placed = place(scene, document, false);
  TrialRun nobody_asks;
  Judge judge(nobody_asks, placed.pointers, wholes_of(scene), patience);
  Controller controller(scene, placed.pointers, {&judge}, &judge.stop);
  Kept kept;
  controller.between_windows = [&](const Pause&) {
    const double middle = 0.5 * (scene.time.begin + scene.time.end);
    if (!kept.run.empty() || judge.time < middle || judge.time >= scene.time.end) return;
    kept.run = controller.save();
    for (Subdomain* body : placed.pointers) kept.bodies.push_back(body->checkpoint());
    kept.start = judge.start;
    kept.scale = nobody_asks.scale;
    kept.impulse = nobody_asks.impulse;
  };
  controller.run();
  return kept;
}

void run_scene(const std::filesystem::path& folder, double patience, Where where, TrialRun& run) {
  const Document document = Document::load((folder / "scene.yaml").string());
  const Scene scene = read_scene(document);
  Kept kept;
  if (where == Where::resumed) kept = keep_middle(scene, document, patience);
  Placed placed = place(scene, document, where == Where::processes);
  Judge judge(run, placed.pointers, wholes_of(scene), patience);
  Controller controller(scene, placed.pointers, {&judge}, &judge.stop);
  if (!kept.run.empty()) {
    controller.load(kept.run);
    judge.start = kept.start;
    run.scale = kept.scale;
    run.impulse = kept.impulse;
    for (std::size_t b = 0; b < kept.bodies.size(); ++b) placed.bodies[b]->resume(kept.bodies[b]);
  }
  controller.run();
  run.finite = run.finite && judge.outsides.finite();
  if (placed.launch != nullptr) placed.launch->finish();
}

}  // namespace

TrialRun try_run(const std::filesystem::path& folder, double patience, Where where) {
  TrialRun run;
  const double before = processor_seconds();
  try {
    run_scene(folder, patience, where, run);
  } catch (const InputError& error) {
    run.status = "refused";
    run.reason = error.what();
  } catch (const std::exception& error) {
    run.status = "threw";
    run.reason = error.what();
  }
  run.seconds = processor_seconds() - before;
  return run;
}

std::string TrialRun::trouble(bool free, bool turns) const {
  if (!completed()) return fmt::format("{}: {}", status, reason);
  if (!finite) return "not finite";
  if (growth > most_growth) return fmt::format("energy grown by {:.2g} of the most", growth);
  if (free && momentum > most_momentum)
    return fmt::format("momentum changed by {:.2g} of the most", momentum);
  if (free && turns && angular > most_angular)
    return fmt::format("angular momentum changed by {:.2g} of the most", angular);
  if (!crossings.empty()) return "crossed: " + crossings[0];
  if (!overlaps.empty()) return "overlap told: " + overlaps[0];
  return {};
}

}  // namespace abut
