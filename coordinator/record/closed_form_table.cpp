#include "coordinator/record/closed_form_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace abut {

namespace {

struct Row {
  std::string quantity, measure;
  double exact = 0.0;
  double scale = 1.0;  // of the error
};

/// A time of 1e-18 s beside one of 5e-4 s is zero.
double clean(double value, double scale) {
  return std::abs(value) < 1.0e-12 * std::abs(scale) ? 0.0 : value;
}

/// What is compared at one interface; `of` tells it from others.
void add_contact(const RowContact& exact, const std::string& interface, const std::string& of,
                 std::vector<Row>& rows) {
  if (!exact.ever()) return;
  const std::string contact = "contact." + interface;
  rows.push_back({of + "contact begins [s]", contact + ".begin", exact.begin(), exact.duration()});
  if (!exact.pressed_at_end)
    rows.push_back({of + "contact ends [s]", contact + ".end", exact.end(), exact.duration()});
  rows.push_back({of + "mean contact force [N]", contact + ".force_mean", exact.force_mean(),
                  exact.force_mean()});
}

}  // namespace

std::string closed_form_table(const ClosedForm& form, double end, const Measures& measures) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < form.interfaces.size(); ++i) {
    const std::string& name = form.interfaces[i];
    const std::string of = form.interfaces.size() > 1 ? name + ": " : "";
    add_contact(form.row.contacts()[i], name, of, rows);
  }
  for (int b = 0; b < form.row.bars(); ++b) {
    if (form.row.bar(b).wall) continue;
    const std::string& body = form.bodies[b];
    rows.push_back({"mean velocity of " + body + " at the end [m/s]",
                    "mean_velocity." + body + ".end", form.row.mean_velocity(b, end),
                    form.row.velocity_spread()});
  }
  std::size_t width = 0;
  for (const Row& row : rows) width = std::max(width, row.quantity.size());
  std::string text = fmt::format("{:<{}}  {:>12}  {:>12}  {:>9}\n", "against the closed form",
                                 width, "exact", "computed", "error");
  for (const Row& row : rows) {
    const auto found = measures.values.find(row.measure);
    if (found == measures.values.end() || std::isnan(found->second)) continue;
    const double got = clean(found->second, row.scale);
    text += fmt::format("{:<{}}  {:>12.6g}  {:>12.6g}  {:>7.3g} %\n", row.quantity, width,
                        clean(row.exact, row.scale), got,
                        100.0 * clean(got - row.exact, row.scale) / row.scale);
  }
  return text;
}

}  // namespace abut
