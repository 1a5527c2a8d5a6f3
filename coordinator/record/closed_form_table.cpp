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

}  // namespace

std::string closed_form_table(const ClosedForm& form, const std::array<std::string, 2>& bodies,
                              double end, const Measures& measures) {
  const BarImpact& exact = form.impact;
  const std::string contact = "contact." + form.interface;
  std::vector<Row> rows = {
      {"contact begins [s]", contact + ".begin", exact.begin(), exact.duration()},
      {"contact ends [s]", contact + ".end", exact.end(), exact.duration()},
      {"mean contact force [N]", contact + ".force_mean", exact.force(), exact.force()}};
  for (int side : {0, 1}) {
    const std::string& body = bodies[static_cast<std::size_t>(side)];
    if (exact.is_wall(side)) continue;
    rows.push_back({"mean velocity of " + body + " at the end [m/s]",
                    "mean_velocity." + body + ".end", exact.mean_velocity(side, end),
                    exact.closing_speed()});
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
