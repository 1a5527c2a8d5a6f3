#include "coordinator/exact/closed_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace abut {
namespace {

[[noreturn]] void refuse_form(const std::string& why) {
  throw InputError(fmt::format("the closed form bar_impact does not describe this impact: {}", why),
                   "meta.closed_form",
                   "Choose closed_form: {bars: {}}, leave it out, or change the bodies.");
}

int index_of(const std::vector<std::string>& names, const std::string& name) {
  const std::vector<std::string>::const_iterator found =
      std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace

int ClosedForm::interface_index(const std::string& interface) const {
  return index_of(interfaces, interface);
}

int ClosedForm::bar_index(const std::string& body) const { return index_of(bodies, body); }

double ClosedForm::contact_time() const {
  std::vector<std::pair<double, double>> spans;
  for (const RowContact& contact : row.contacts())
    for (const RowContact::Stretch& s : contact.stretches) spans.emplace_back(s.begin, s.end);
  std::sort(spans.begin(), spans.end());
  double sum = 0.0, covered = -std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : spans) {
    sum += std::max(0.0, to - std::max(from, covered));
    covered = std::max(covered, to);
  }
  return sum;
}

BarRow bar_impact(const std::array<RowBar, 2>& bodies, const std::array<BarEnd, 2>& ends,
                  double begin, double end) {
  double closing = 0.0, echo = std::numeric_limits<double>::infinity();
  for (const BarEnd& e : ends) {
    const RowBar& body = bodies[e.bar];
    if (body.wall) continue;
    if (body.fixed[0] || body.fixed[1]) refuse_form(fmt::format("{} has a fixed end", body.name));
    closing += e.normal() * body.velocity;
    echo = std::min(echo, 2.0 * body.length * std::sqrt(body.density / body.youngs_modulus));
  }
  if (!(closing > 0.0))
    refuse_form(
        fmt::format("{} and {} do not approach each other", bodies[0].name, bodies[1].name));
  const std::vector<RowBar> bars(bodies.begin(), bodies.end());
  const double touch = begin + BarRow(bars, {ends}, begin, begin).gap(0, begin) / closing;
  BarRow row(bars, {ends}, begin, std::max(end, touch + 2.0 * echo));
  const RowContact& contact = row.contacts()[0];
  if (contact.count() > 1)
    refuse_form(fmt::format("{} and {} meet again at {:.6g} s", bodies[0].name, bodies[1].name,
                            contact.stretches[1].begin));
  if (contact.stretches.size() > 1)
    refuse_form(fmt::format(
        "when the first echo is back, at {:.6g} s, the contact force falls from "
        "{:.6g} N to {:.6g} N instead of ending",
        contact.stretches[1].begin, contact.stretches[0].force, contact.stretches[1].force));
  return row;
}

}  // namespace abut
