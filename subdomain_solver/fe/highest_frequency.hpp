#pragma once

#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/slower_cells.hpp"
#include "subdomain_solver/time/frequency_watch.hpp"

namespace abut {

/// Bounds the frequencies of a deformed model by those of its cells alone with their shares of the
/// lumped mass [M.53]. Pivots of square x M_e - K_e tell slower cells, eight at a time where
/// tangents have a batched form, and eigenvalues are computed of the others. Cells with batched
/// forces are first held against a bound from the tangent moduli of their points and the cell's
/// shape [M.58].
class HighestFrequency final : public FrequencyWatch {
 public:
  explicit HighestFrequency(FeModel& model);

  [[nodiscard]] std::optional<Bound> bound(std::span<const double> q,
                                           std::span<const double> history, double from,
                                           Effort effort) override;
  std::string place(const Bound& bound) const override;
  int least_interval() const override { return cells_ != nullptr ? 40 : 128; }

 private:
  [[nodiscard]] bool compute(int block, int cell, std::span<const double> q,
                             std::span<const double> history, Bound& best);
  std::optional<Bound> batched_bound(std::span<const double> q, std::span<const double> history,
                                     double from);
  std::optional<Bound> fast_bound(std::span<const double> q, std::span<const double> history,
                                  double from);
  std::optional<Bound> cell_bound(std::span<const double> q, std::span<const double> history,
                                  double from);
  [[nodiscard]] bool raise(int block, int cell, std::span<const double> q,
                           std::span<const double> history, Bound& best);
  std::span<const double> in_space(std::span<const double> q);
  void find_scales();
  void find_masses();
  double scale_of(int block, int cell);

  FeModel& model_;
  BatchedCells* cells_;                    // that have bounds; null: cell by cell
  SlowerCells slower_;                     // of cells one by one
  std::vector<double> scales_;             // [Pa s^2/m^2] (patches, batches, 8) of batched cells
  double floor_ = 0.0;                     // [1/s^2] below which the batched bound does not tell
  std::vector<double> masses_;             // [kg] (blocks, cells, nodes) of cells one by one
  std::vector<std::size_t> first_mass_;    // (blocks)
  std::vector<BatchedCells::Place> fast_;  // work space
  std::vector<double> u_;                  // work space
  Eigen::MatrixXd stiffness_, shifted_;    // work space
};

}  // namespace abut
