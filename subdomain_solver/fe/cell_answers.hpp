#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/worker_threads.hpp"
#include "subdomain_solver/fe/batched_stiffness.hpp"
#include "subdomain_solver/fe/cell_kernel.hpp"
#include "subdomain_solver/fe/cell_measures.hpp"

namespace abut {

/// What consecutive cells of one element are asked.
struct CellsAsked {
  const CellMeasures& measures;
  int first = 0, count = 0;
  /// Displacements [m] (nodes, dim) of a cell, in the axes of space.
  std::function<void(int cell, std::vector<double>& u)> displacement;
  std::span<const double> before;  // histories, of the first cell on
  std::span<double> after;
};

/// Answers of many cells, computed by threads: each its own, so that nothing depends on their
/// number. Who adds them up does so in the order of the cells.
class CellAnswers {
 public:
  /// `threads`: of somebody else, or null: as many of its own. Batches: tangents are found for 8
  /// cells at once where the law can.
  CellAnswers(const Material& material, const FeOptions& options, int dim, WorkerThreads* threads,
              bool batches);

  WorkerThreads& threads() { return threads_; }
  /// From now on laws are stiffened, or not, where they are crushed [M.140].
  void guard(bool on);
  /// Cells that are asked at a time, at most.
  int most() const { return most_; }
  /// Forces, energies and histories, and tangents where needed. False: a cell has no answer.
  [[nodiscard]] bool evaluate(const CellsAsked& asked, Need need);
  /// Whether tangents of such cells are found for several at once, alone.
  bool batched(const CellMeasures& measures) const;
  [[nodiscard]] bool find_tangents(const CellsAsked& asked);
  /// Of the k-th cell that was asked last.
  CellResponse& of(int k) { return answers_[index(k)]; }

 private:
  struct Worker {
    explicit Worker(const Material& material) : kernel(material) {}
    CellKernel kernel;
    std::vector<double> one, displacement, volume, gradient, stiffness;
  };
  void answer(const CellsAsked& asked, Need need, std::size_t task, Worker& worker);
  void find_tangents(const CellsAsked& asked, std::size_t task, Worker& worker);
  template <class Answer>
  bool ask_all(const CellsAsked& asked, const Answer& answer);

  std::optional<WorkerThreads> own_;
  WorkerThreads& threads_;
  std::vector<Worker> workers_;
  std::vector<CellResponse> answers_;
  std::vector<unsigned char> answered_;  // (tasks)
  int most_;
  StiffnessKernel stiffness_ = nullptr;
  bool one_volume_ = false, guarded_ = false;
  BatchedParameters parameters_;
};

}  // namespace abut
