#include "subdomain_solver/fe/batched_cells.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "base/vector_units.hpp"
#include "subdomain_solver/fe/batched_law.hpp"
#include "subdomain_solver/fe/cell_measures.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"

namespace abut {

namespace {

std::optional<BatchedCell> cell_of(const Element& element, Formulation formulation) {
  const auto choose = [formulation](BatchedCell full, BatchedCell mean, BatchedCell one_point) {
    if (formulation == Formulation::mean_dilatation) return mean;
    return formulation == Formulation::one_point ? one_point : full;
  };
  using enum BatchedCell;
  if (element.name == "hex8") return choose(hex8, hex8_mean_dilatation, hex8_one_point);
  if (element.name == "quad4") return choose(quad4, quad4_mean_dilatation, quad4_one_point);
  if (element.name == "tet4") return tet4;
  if (element.name == "tri3") return tri3;
  if (formulation != Formulation::full) return std::nullopt;
  if (element.name == "tet10") return tet10;
  if (element.name == "hex20") return hex20;
  return std::nullopt;
}

HardeningNumbers hardening_of(const Material& material) {
  const auto* law = dynamic_cast<const J2Plasticity*>(&material);
  if (law == nullptr) return {};
  const Hardening& h = law->hardening();
  HardeningNumbers numbers{h.yield_stress, h.modulus, 0.0, 0.0};
  if (h.saturation) {
    numbers.rise = h.saturation->stress - h.yield_stress;
    numbers.rate = h.saturation->rate;
  }
  return numbers;
}

MooneyRivlinNumbers invariants_of(const Material& material) {
  const auto* law = dynamic_cast<const MooneyRivlin*>(&material);
  return law == nullptr ? MooneyRivlinNumbers{} : law->numbers();
}

/// Rows of Dim numbers, wherever they lie, to rows of 4, and back.
template <int Dim>
void copy_in(const std::vector<std::int32_t>& nodes, const double* from, double* to) {
  for (const std::int32_t node : nodes) {
    const double* row = from + index(node) * Dim;
    for (int i = 0; i < Dim; ++i) to[i] = row[i];
    to += 4;
  }
}
template <int Dim>
void copy_out(std::span<const std::int32_t> nodes, const double* from, double* to) {
  for (const std::int32_t node : nodes) {
    double* row = to + index(node) * Dim;
    for (int i = 0; i < Dim; ++i) row[i] = from[i];
    from += 4;
  }
}

}  // namespace

std::vector<const KernelTable*> batched_kernels() {
  std::vector<const KernelTable*> tables;
#if defined(__x86_64__)
  if (has_x86_64_v4()) tables.push_back(&batched_kernels_avx512());
  if (has_x86_64_v3()) tables.push_back(&batched_kernels_avx2());
#endif
  tables.push_back(&batched_kernels_generic());
  return tables;
}

bool BatchedCells::can(const Mesh& mesh, const Material& material, Formulation formulation) {
  const std::optional<BatchedLaw> law = batched_law_of(material);
  return law && std::all_of(mesh.blocks.begin(), mesh.blocks.end(),
                            [law, formulation](const CellBlock& block) {
                              const auto cell = cell_of(*block.element, formulation);
                              return block.shares.empty() && cell &&
                                     batched_kernels_generic().of(*cell, *law) != nullptr;
                            });
}

BatchedCells::BatchedCells(const Mesh& mesh, const Material& material,
                           const BatchedOptions& options)
    : dim_(mesh.dim),
      patches_(mesh),
      table_(options.kernels != nullptr ? *options.kernels : *batched_kernels().front()),
      threads_(options.threads) {
  ABUT_ASSERT(can(mesh, material, options.formulation));
  const BatchedParameters of_law{material.moduli(), options.hourglass * material.moduli().p_wave(),
                                 options.thickness, hardening_of(material),
                                 invariants_of(material)};
  rules_.reserve(mesh.blocks.size());
  for (const CellBlock& block : mesh.blocks) {
    const Element& element = *block.element;
    const Tabulation& rule = rules_.emplace_back(
        tabulate(element, quadrature(element.shape, stiffness_degree(element))));
    BatchedParameters& own = parameters_.emplace_back(of_law);
    own.points = rule.points;
    own.weight = rule.weight.data();
    own.slope = rule.dn.data();
    const BatchedCell cell = *cell_of(*block.element, options.formulation);
    kernels_.push_back(table_.of(cell, *batched_law_of(material)));
    frequencies_.push_back(table_.frequency_of(cell, *batched_law_of(material)));
  }
  copies_.resize(index(threads_.count()));
  for (Copies& c : copies_) {
    c.displacement.resize(4 * patches_.most_copies());
    c.force.resize(4 * patches_.most_copies());
  }
  shared_.resize(patches_.shared_copies() * index(dim_));
  energies_.resize(patches_.list().size());
  answers_.resize(patches_.list().size());
  if (material.history_size() > 0) {
    for (std::size_t b = 0; b < rules_.size(); ++b)
      cell_numbers_.push_back(material.history_size() *
                              law_points(*mesh.blocks[b].element, rules_[b], options.formulation));
    place_histories(mesh, options.first_history);
  }
}

/// Lanes without a cell have none.
void BatchedCells::place_histories(const Mesh& mesh,
                                   const std::vector<std::vector<std::int64_t>>& given) {
  std::vector<std::int64_t> first = {0};  // of the blocks
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    first.push_back(first.back() + std::int64_t{mesh.blocks[b].count()} * cell_numbers_[b]);
  for (const CellPatch& patch : patches_.list()) {
    std::vector<std::int64_t>& list = first_history_.emplace_back();
    for (const std::int32_t cell : patch.cells)
      list.push_back(given.empty() ? first[patch.block] + cell * cell_numbers_[patch.block]
                                   : given[patch.block][cell]);
    list.resize(index(patch.batches) * batch_lanes, -1);
  }
}

PatchView BatchedCells::view_of(std::size_t p, Copies& copies, const Histories& histories) const {
  const CellPatch& patch = patches_.list()[p];
  PatchView view;
  view.batches = patch.batches;
  view.nodes = patch.places.data();
  view.reference = patch.reference.data();
  view.displacement = copies.displacement.data();
  view.force = copies.force.data();
  if (first_history_.empty()) return view;
  view.first_history = first_history_[p].data();
  view.before = histories.before;
  view.after = histories.after;
  return view;
}

void BatchedCells::copy_displacement(const CellPatch& patch, Copies& copies,
                                     std::span<const double> q) const {
  double* u = copies.displacement.data();
  if (dim_ == 3)
    copy_in<3>(patch.nodes, q.data(), u);
  else
    copy_in<2>(patch.nodes, q.data(), u);
  std::fill(u + 4 * patch.nodes.size(), u + patch.reference.size(), 0.0);
}

void BatchedCells::evaluate(std::size_t p, Copies& copies, std::span<const double> q,
                            const Histories& histories, std::span<double> force) {
  const CellPatch& patch = patches_.list()[p];
  copy_displacement(patch, copies, q);
  std::fill_n(copies.force.begin(), patch.reference.size(), 0.0);
  PatchView view = view_of(p, copies, histories);
  answers_[p] = kernels_[patch.block](view, parameters_[index(patch.block)]);
  energies_[p] = {};
  for (const double energy : view.stored) energies_[p].stored += energy;
  for (const double energy : view.dissipated) energies_[p].dissipated += energy;
  const std::span<const std::int32_t> own = std::span(patch.nodes).first(index(patch.own));
  if (dim_ == 3)
    copy_out<3>(own, copies.force.data(), force.data());
  else
    copy_out<2>(own, copies.force.data(), force.data());
  const std::size_t dim = index(dim_);
  for (std::size_t n = own.size(); n < patch.nodes.size(); ++n)
    for (std::size_t i = 0; i < dim; ++i)
      shared_[(patch.first_shared + n - own.size()) * dim + i] = copies.force[4 * n + i];
}

bool BatchedCells::evaluate(std::span<const double> q, const PointHistories& histories,
                            std::span<double> force, CellEnergies& energies) {
  const Histories numbers{histories.before.data(),
                          histories.after.empty() ? nullptr : histories.after.data()};
  // Handed on by reference: a copy of what the lambdas hold would be allocated.
  const auto ask = [this, q, numbers, force](std::size_t patch, int worker) {
    evaluate(patch, copies_[worker], q, numbers, force);
  };
  threads_.run(patches_.list().size(), std::ref(ask));
  const std::size_t dim = index(dim_), count = patches_.shared_count();
  constexpr std::size_t each = 4096;  // shared nodes of one task
  const auto add = [this, force, dim, count](std::size_t task, int) {
    for (std::size_t s = task * each; s < std::min(count, (task + 1) * each); ++s) {
      const CellPatches::SharedNode node = patches_.shared(s);
      for (std::size_t i = 0; i < dim; ++i) {
        double sum = 0.0;
        for (const std::int32_t copy : node.copies) sum += shared_[index(copy) * dim + i];
        force[index(node.node) * dim + i] = sum;
      }
    }
  };
  threads_.run((count + each - 1) / each, std::ref(add));
  energies = {};
  for (const CellEnergies& of_patch : energies_) {
    energies.stored += of_patch.stored;
    energies.dissipated += of_patch.dissipated;
  }
  return std::isfinite(energies.stored) && std::isfinite(energies.dissipated) &&
         std::find(answers_.begin(), answers_.end(), 0) == answers_.end();
}

/// Answers the questions of all patches.
void BatchedCells::ask_all(std::span<const double> q, std::span<const double> history,
                           std::span<const double> scales) {
  const std::vector<CellPatch>& list = patches_.list();
  const double* scale = scales.data();
  for (std::size_t p = 0; p < list.size(); ++p) {
    questions_[p].scale = scale;
    questions_[p].cells = static_cast<int>(list[p].cells.size());
    scale += list[p].batches * batch_lanes;
  }
  ABUT_ASSERT(scale == scales.data() + scales.size());
  const auto ask = [this, q, history](std::size_t p, int worker) {
    const CellPatch& patch = patches_.list()[p];
    Copies& copies = copies_[worker];
    copy_displacement(patch, copies, q);
    const PatchView view = view_of(p, copies, {history.data(), nullptr});
    frequencies_[patch.block](view, parameters_[index(patch.block)], questions_[p]);
  };
  threads_.run(list.size(), std::ref(ask));
}

bool BatchedCells::bounds() const {
  return std::ranges::find(frequencies_, nullptr) == frequencies_.end();
}

double BatchedCells::bound_frequencies(std::span<const double> q, std::span<const double> history,
                                       double from, std::span<const double> scales) {
  questions_.assign(patches_.list().size(), {nullptr, 0, from, nullptr, 0});
  ask_all(q, history, scales);
  double most = from;
  for (const FrequencyQuestion& question : questions_) most = std::max(most, question.square);
  return most;
}

void BatchedCells::find_fast(std::span<const double> q, std::span<const double> history,
                             double square, std::span<const double> scales,
                             std::vector<Place>& out) {
  const std::vector<CellPatch>& list = patches_.list();
  questions_.assign(list.size(), {nullptr, 0, square, nullptr, 0});
  fast_.resize(list.size());
  for (std::size_t p = 0; p < list.size(); ++p) {
    fast_[p].resize(list[p].cells.size());
    questions_[p].fast = fast_[p].data();
  }
  ask_all(q, history, scales);
  for (std::size_t p = 0; p < list.size(); ++p)
    for (int k = 0; k < questions_[p].found; ++k)
      out.push_back({list[p].block, list[p].cells[fast_[p][index(k)]]});
}

std::size_t BatchedCells::bytes() const {
  std::size_t sum =
      patches_.bytes() + shared_.size() * sizeof(double) + energies_.size() * sizeof(CellEnergies);
  for (const Copies& c : copies_) sum += (c.displacement.size() + c.force.size()) * sizeof(double);
  for (const std::vector<std::int64_t>& list : first_history_)
    sum += list.size() * sizeof(std::int64_t);
  return sum;
}

}  // namespace abut
