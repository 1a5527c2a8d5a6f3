#include "coordinator/body_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coordinator/record/text_table.hpp"

namespace abut {

namespace {

constexpr std::size_t many = 4;  // equal rows from here on are one

using Cells = std::vector<std::string>;

std::string number(double value) { return value > 0.0 ? fmt::format("{:.4g}", value) : "-"; }

std::string extent_of(const BodyFacts& facts) {
  std::string text;
  for (std::size_t i = 0; i < facts.low.size(); ++i)
    text += fmt::format("{}{:.3g}", i == 0 ? "" : " x ", facts.high[i] - facts.low[i]);
  return text.empty() ? "-" : text;
}

/// All cells but the name.
Cells cells_of(const Description& body, const BodyFacts& facts) {
  const double limit = stable_limit(body, facts);
  const bool is_explicit = limit > 0.0 && std::isfinite(body.stable_step);
  const std::string over =
      limit > 0.0 && body.step > 0.0
          ? fmt::format("{:.3g}{}", limit / body.step, is_explicit ? "" : " implicit")
          : "-";
  return {extent_of(facts),
          std::isinf(body.mass) ? "immovable" : number(body.mass),
          number(facts.wave_speed),
          number(body.step),
          number(limit),
          over};
}

}  // namespace

double stable_limit(const Description& body, const BodyFacts& facts) {
  if (std::isfinite(body.stable_step) && body.stable_step > 0.0) return body.stable_step;
  return facts.explicit_limit;
}

std::string body_table(std::span<const Description* const> bodies,
                       std::span<const std::optional<BodyFacts>> facts) {
  std::vector<Cells> rows = {{"body", "extent [m]", "mass [kg]", "fastest wave [m/s]", "step [s]",
                              "stable to [s]", "stable/step"}};
  for (std::size_t first = 0, last = 0; first < bodies.size(); first = last + 1) {
    last = first;
    if (bodies[first] == nullptr || !facts[first]) continue;
    const Cells cells = cells_of(*bodies[first], *facts[first]);
    const auto equal = [&](std::size_t b) {
      return b < bodies.size() && bodies[b] != nullptr && facts[b] &&
             cells_of(*bodies[b], *facts[b]) == cells;
    };
    while (equal(last + 1)) ++last;
    if (last - first + 1 < many) last = first;
    std::string name = bodies[first]->name;
    if (last > first) name += " to " + bodies[last]->name;
    rows.push_back({std::move(name)});
    rows.back().insert(rows.back().end(), cells.begin(), cells.end());
  }
  return rows.size() > 1 ? text_table(rows, "  ") : "";
}

}  // namespace abut
