#include "subdomain_solver/validity_measures.hpp"

#include <algorithm>

#include "subdomain_solver/fe/hourglass.hpp"
#include "subdomain_solver/fe/largest_rotation.hpp"

namespace abut {

namespace {

/// Cells that are looked at on the way.
constexpr int few_cells = 64;

bool turns(const FeModel& model, bool deforms) {
  return deforms && model.is_linear() && model.mesh().dim > 1;
}

bool has_hourglass_energy(const FeModel& model, bool deforms) {
  if (!deforms || model.options().formulation != Formulation::one_point) return false;
  const std::vector<CellBlock>& blocks = model.mesh().blocks;
  return std::any_of(blocks.begin(), blocks.end(),
                     [](const CellBlock& cells) { return has_hourglasses(*cells.element); });
}

/// By its surface, which has no mass.
bool turns_faster(const FeModel& model, bool deforms) {
  return deforms && model.inertia_left() < 1.0;
}

}  // namespace

std::vector<std::string> validity_measure_names(const FeModel& model, bool deforms) {
  std::vector<std::string> names;
  if (turns_faster(model, deforms)) names.insert(names.end(), {"inertia.left", "inertia.turned"});
  if (turns(model, deforms)) names.emplace_back("rotation.max");
  if (has_hourglass_energy(model, deforms))
    names.insert(names.end(), {"energy.hourglass", "energy.hourglass_share"});
  return names;
}

std::vector<double> validity_measures(const FeModel& model, bool deforms, std::span<const double> u,
                                      double stored, double turned) {
  std::vector<double> out;
  const bool faster = turns_faster(model, deforms), small = turns(model, deforms);
  if (faster || small) turned = std::max(turned, largest_rotation(model.mesh(), u));
  if (faster) out.insert(out.end(), {model.inertia_left(), turned});
  if (small) out.push_back(turned);
  if (has_hourglass_energy(model, deforms)) {
    const double energy = hourglass_energy(model, u);
    out.insert(out.end(), {energy, stored > 0.0 ? energy / stored : 0.0});
  }
  return out;
}

double rotation_on_the_way(const FeModel& model, bool deforms, std::span<const double> u) {
  if (!turns(model, deforms)) return 0.0;
  return largest_rotation(model.mesh(), u, (model.mesh().cell_count() - 1) / few_cells + 1);
}

}  // namespace abut
