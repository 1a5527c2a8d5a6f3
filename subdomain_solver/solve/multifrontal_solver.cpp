#include "subdomain_solver/solve/multifrontal_solver.hpp"

#include <algorithm>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "base/vector_units.hpp"
#include "subdomain_solver/solve/eigen_solver.hpp"
#include "subdomain_solver/solve/front_elimination.hpp"
#include "subdomain_solver/solve/front_substitution.hpp"
#include "subdomain_solver/solve/fronts.hpp"

namespace abut {

Eliminate& eliminate_here() {
#ifdef __x86_64__
  if (has_x86_64_v4()) return eliminate_avx512;
  if (has_x86_64_v3()) return eliminate_avx2;
#endif
  return eliminate_generic;
}

const FrontSubstitution& substitution_here() {
#ifdef __x86_64__
  if (has_x86_64_v4()) return substitute_avx512;
  if (has_x86_64_v3()) return substitute_avx2;
#endif
  return substitute_generic;
}

namespace {

using Block = Eigen::Map<Eigen::MatrixXd>;

DenseView block_view(Block& of) { return {of.data(), of.rows(), of.cols(), of.rows()}; }

class Multifrontal final : public LinearSolver {
 public:
  Multifrontal(Pivots pivots, WorkerThreads* threads) : pivots_(pivots) {
    if (threads != nullptr && threads->count() > 1) team_ = {threads, threads->count(), run};
  }

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (entries_ < 0) analyse(matrix);
    ABUT_ASSERT(entries_ == matrix.nonZeros());
    const double* entries = matrix.valuePtr();
    std::ranges::fill(values_, 0.0);
    for (std::size_t k = 0; k < from_.size(); ++k) values_[to_[k]] = entries[from_[k]];
    waiting_.clear();
    std::size_t top = 0;
    for (const Front& front : fronts_.list)
      if (!eliminate_front(front, top)) return false;
    return pivots_hold(matrix);
  }

  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x.resize(b.size());
    solve_some(b.data(), x.data(), 1);
    return x.allFinite();
  }
  [[nodiscard]] bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) override {
    x.resize(b.rows(), b.cols());
    for (Eigen::Index first = 0; first < b.cols(); first += together)
      solve_some(b.data() + first * b.rows(), x.data() + first * b.rows(),
                 std::min(together, b.cols() - first));
    return x.allFinite();
  }

 private:
  static void run(void* self, std::size_t tasks, Team::Work* work, const void* argument) {
    static_cast<WorkerThreads*>(self)->run(
        tasks, [work, argument](std::size_t task, int worker) { work(argument, task, worker); });
  }
  void analyse(const SparseMatrix& matrix) {
    ABUT_ASSERT(matrix.isCompressed());
    entries_ = matrix.nonZeros();
    fronts_ = find_fronts(matrix);
    values_.resize(fronts_.values);
    stack_.resize(fronts_.stack);
    rest_.resize(fronts_.largest_rest);
    space_.resize(fronts_.space + elimination_space(0, 0, index(team_.workers - 1)));
    find_places(matrix);
  }

  /// Where each entry of the lower half goes.
  void find_places(const SparseMatrix& matrix) {
    std::vector<int> place(fronts_.order.size()), row(fronts_.order.size(), -1);
    for (std::size_t k = 0; k < place.size(); ++k) place[fronts_.order[k]] = static_cast<int>(k);
    for (const Front& front : fronts_.list) {
      for (int k = 0; k < front.rows; ++k) row[fronts_.rows[front.list + index(k)]] = k;
      for (int c = 0; c < front.columns; ++c) {
        const int column = fronts_.order[front.first + c];
        for (int k = matrix.outerIndexPtr()[column]; k < matrix.outerIndexPtr()[column + 1]; ++k) {
          const int at = place[index(matrix.innerIndexPtr()[k])];
          if (at < front.first + c) continue;
          from_.push_back(k);
          to_.push_back(front.values + index(c) * index(front.rows) + index(row[at]));
        }
      }
    }
  }

  Block block_of(const Front& front) {
    return {values_.data() + front.values, front.rows, front.columns};
  }

  bool eliminate_front(const Front& front, std::size_t& top) {
    Block block = block_of(front), rest(rest_.data(), front.rest(), front.rest());
    rest.setZero();
    for (int child = 0; child < front.children; ++child) {
      const Front& from = *waiting_.back();
      waiting_.pop_back();
      top -= index(from.rest()) * index(from.rest());
      add(from, stack_.data() + top, block, rest);
    }
    if (!eliminate_(block_view(block), block_view(rest), space_.data(), team_)) return false;
    if (front.rest() == 0) return true;
    waiting_.push_back(&front);
    std::ranges::copy_n(rest_.data(), rest.size(), stack_.data() + top);
    top += index(rest.size());
    return true;
  }

  /// The rest of a child, to its parent's columns and rest.
  void add(const Front& from, const double* values, Block& block, Block& rest) const {
    const int n = from.rest(), columns = static_cast<int>(block.cols());
    const int* place = fronts_.in_parent.data() + from.list + from.columns;
    for (int c = 0; c < n; ++c) {
      const double* value = values + static_cast<std::ptrdiff_t>(c) * n;
      if (place[c] < columns) {
        double* to = &block(0, place[c]);
        for (int k = c; k < n; ++k) to[place[k]] += value[k];
      } else {
        double* to = rest.data() + (place[c] - columns) * rest.rows() - columns;
        for (int k = c; k < n; ++k) to[place[k]] += value[k];
      }
    }
  }

  bool pivots_hold(const SparseMatrix& matrix) {
    if (pivots_ == Pivots::every) return true;
    for (const Front& front : fronts_.list) {
      const Block block = block_of(front);
      for (int c = 0; c < front.columns; ++c) {
        const int at = fronts_.order[front.first + c];
        const double pivot = block(c, c);
        const bool holds = pivots_ == Pivots::definite
                               ? pivot > 0.0
                               : pivot_holds(pivot, matrix.coeff(at, at), matrix.cols());
        if (!holds) return false;
      }
    }
    return true;
  }

  /// Right sides (n, count), and their answers.
  void solve_some(const double* b, double* x, Eigen::Index count) {
    const Eigen::Index n = static_cast<Eigen::Index>(fronts_.order.size());
    work_.resize(std::max(work_.size(), n * count));
    gathered_.resize(std::max(gathered_.size(), index(fronts_.longest) * index(count)));
    Block work(work_.data(), n, count);
    for (Eigen::Index c = 0; c < count; ++c)
      for (Eigen::Index k = 0; k < n; ++k) work(k, c) = b[fronts_.order[index(k)] + c * n];
    for (const Front& front : fronts_.list) go_forward(front, work);
    for (auto front = fronts_.list.rbegin(); front != fronts_.list.rend(); ++front)
      go_back(*front, work);
    for (Eigen::Index c = 0; c < count; ++c)
      for (Eigen::Index k = 0; k < n; ++k) x[fronts_.order[index(k)] + c * n] = work(k, c);
  }

  /// Right sides that have nothing at its columns pass: forces on a surface meet few fronts.
  void go_forward(const Front& front, Block& x) {
    auto own = x.middleRows(front.first, front.columns);
    if (own.isZero(0.0)) return;
    Block values(gathered_.data(), front.rows, x.cols());
    values.topRows(front.columns) = own;
    values.bottomRows(front.rest()).setZero();
    Block block = block_of(front);
    substitution_.forward(block_view(block), block_view(values));
    own = values.topRows(front.columns);
    const int* row = fronts_.rows.data() + front.list;
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      for (int k = front.columns; k < front.rows; ++k) x(row[k], c) += values(k, c);
  }
  void go_back(const Front& front, Block& x) {
    Block values(gathered_.data(), front.rows, x.cols());
    const int* row = fronts_.rows.data() + front.list;
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      for (int k = 0; k < front.rows; ++k) values(k, c) = x(row[k], c);
    Block block = block_of(front);
    substitution_.backward(block_view(block), block_view(values));
    x.middleRows(front.first, front.columns) = values.topRows(front.columns);
  }

  Pivots pivots_;
  Team team_;
  Fronts fronts_;
  Eigen::Index entries_ = -1;    // of the matrix
  std::vector<int> from_;        // of its lower half, in the order of elimination
  std::vector<std::size_t> to_;  // among the values
  std::vector<double> values_;   // of the factor
  std::vector<double> stack_;    // rests that wait for their parents
  std::vector<const Front*> waiting_;
  std::vector<double> rest_;
  std::vector<double> space_;
  Eliminate& eliminate_ = eliminate_here();
  const FrontSubstitution& substitution_ = substitution_here();
  Vector work_;                                // right sides in the order of elimination
  std::vector<double> gathered_;               // what they have at a front's rows
  static constexpr Eigen::Index together = 8;  // that stay in the cache beside a front's columns
};

}  // namespace

std::unique_ptr<LinearSolver> make_multifrontal_solver(Pivots pivots, WorkerThreads* threads) {
  return std::make_unique<Multifrontal>(pivots, threads);
}

}  // namespace abut
