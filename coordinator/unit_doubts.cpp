#include "coordinator/unit_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "coordinator/body_table.hpp"

namespace abut {

namespace {

constexpr double far_below = 1000.0;  // of a step and its limit
constexpr double far_apart = 1.0e6;   // of two sizes
constexpr double rounding = 1.0e-9;   // of such ratios
constexpr double crushing = 0.5;      // speed of a body over that of its waves

double size_of(const BodyFacts& facts) {  // [m] from corner to corner
  double size = 0.0;
  for (std::size_t i = 0; i < facts.low.size(); ++i)
    size = std::hypot(size, facts.high[i] - facts.low[i]);
  return size;
}

/// Places in the text, so that copies of a body are told of once.
class Doubts {
 public:
  explicit Doubts(const Document& document) : document_(document) {}

  void add(const std::string& body, const std::string& key, std::string what, std::string remedy) {
    std::string where = document_.where("bodies." + body + "." + key);
    if (!places_.insert(where).second) return;
    all_.emplace_back(std::move(what), std::move(where), std::move(remedy));
  }
  std::vector<InputError> take() { return std::move(all_); }

 private:
  const Document& document_;
  std::set<std::string> places_;
  std::vector<InputError> all_;
};

void look_at_step(const Description& body, const BodyFacts& facts, const UnitSystem& units,
                  Doubts& doubts) {
  const double limit = stable_limit(body, facts);
  if (facts.step_key.empty() || !(body.step > 0.0)) return;
  if (limit < far_below * body.step * (1.0 + rounding)) return;
  doubts.add(body.name, facts.step_key,
             fmt::format("{0:g} {3} is {1:.3g} times below the {2:.3g} {3} up to which explicit "
                         "steps are stable",
                         body.step, limit / body.step, limit, units.word("s")),
             "Look at the units of the step, of the mesh and of the material; or give a longer "
             "step.");
}

/// What meets something at the speed of its waves is strained by about 1.
void look_at_speed(const Description& body, const BodyFacts& facts, const UnitSystem& units,
                   Doubts& doubts) {
  if (!(facts.wave_speed > 0.0) || facts.speed < crushing * facts.wave_speed) return;
  doubts.add(body.name, "initial.velocity",
             fmt::format("{0:.3g} {2} is {1:.2g} times the {3:.3g} {2} of the body's fastest wave",
                         facts.speed, facts.speed / facts.wave_speed, units.word("m/s"),
                         facts.wave_speed),
             "Look at the units of the velocity and of the material: what meets anything so fast "
             "is crushed.");
}

/// The smallest body beside the largest.
void look_at_sizes(std::span<const Description* const> bodies,
                   std::span<const std::optional<BodyFacts>> facts, const UnitSystem& units,
                   Doubts& doubts) {
  std::size_t small = bodies.size(), large = bodies.size();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b] == nullptr || !facts[b] || !(size_of(*facts[b]) > 0.0)) continue;
    if (small == bodies.size() || size_of(*facts[b]) < size_of(*facts[small])) small = b;
    if (large == bodies.size() || size_of(*facts[b]) > size_of(*facts[large])) large = b;
  }
  if (small == bodies.size()) return;
  const double least = size_of(*facts[small]), most = size_of(*facts[large]);
  if (most < far_apart * least * (1.0 - rounding)) return;
  doubts.add(
      bodies[small]->name, facts[small]->size_key,
      fmt::format("makes a body of {0:.3g} {4} from corner to corner, and that of '{1}' is "
                  "{2:.3g} {4}, {3:.2g} times as large",
                  least, bodies[large]->name, most, most / least, units.word("m")),
      "Look at the units of both meshes: the scale of a mesh file is the length of its unit.");
}

}  // namespace

std::vector<InputError> unit_doubts(std::span<const Description* const> bodies,
                                    std::span<const std::optional<BodyFacts>> facts,
                                    const Document& document) {
  Doubts doubts(document);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b] == nullptr || !facts[b]) continue;
    look_at_step(*bodies[b], *facts[b], document.units(), doubts);
    look_at_speed(*bodies[b], *facts[b], document.units(), doubts);
    if (!facts[b]->material_doubt.empty())
      doubts.add(bodies[b]->name, facts[b]->material_key, facts[b]->material_doubt,
                 facts[b]->material_remedy);
  }
  look_at_sizes(bodies, facts, document.units(), doubts);
  return doubts.take();
}

}  // namespace abut
