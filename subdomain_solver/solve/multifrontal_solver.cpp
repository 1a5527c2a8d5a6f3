#include "subdomain_solver/solve/multifrontal_solver.hpp"

#include <algorithm>
#include <functional>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "base/vector_units.hpp"
#include "subdomain_solver/solve/branches.hpp"
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
    if (threads == nullptr || threads->count() == 1) return;
    threads_ = threads;
    team_ = {threads, threads->count(), run};
  }

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (entries_ < 0) analyse(matrix);
    ABUT_ASSERT(entries_ == matrix.nonZeros());
    entry_ = matrix.valuePtr();
    return (threads_ == nullptr ? eliminate_all() : eliminate_branches()) && pivots_hold(matrix);
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
    branches_ = find_branches(fronts_);
    values_.resize(fronts_.values);
    work_places_.resize(index(team_.workers));
    for (WorkPlace& place : work_places_) {
      const bool first = &place == work_places_.data();
      const std::size_t top = threads_ == nullptr ? fronts_.stack : branches_.top_stack;
      place.stack.resize(first ? std::max(top, branches_.stack) : branches_.stack);
      place.rest.resize(fronts_.largest_rest);
      place.space.resize(fronts_.space +
                         (first ? elimination_space(0, 0, index(team_.workers - 1)) : 0));
    }
    find_places(matrix);
    if (threads_ == nullptr) return;
    for (const Branch& branch : branches_.list)
      rests_.emplace_back(index(branch.rest) * index(branch.rest));
    done_.resize(branches_.list.size());
  }

  /// Where each entry of the lower half goes.
  void find_places(const SparseMatrix& matrix) {
    std::vector<int> place(fronts_.order.size()), row(fronts_.order.size(), -1);
    for (std::size_t k = 0; k < place.size(); ++k) place[fronts_.order[k]] = static_cast<int>(k);
    for (const Front& front : fronts_.list) {
      first_entry_.push_back(from_.size());
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
    first_entry_.push_back(from_.size());
  }

  Block block_of(const Front& front) {
    return {values_.data() + front.values, front.rows, front.columns};
  }

  bool eliminate_all() {
    WorkPlace& at = work_places_[0];
    at.clear();
    for (const Front& front : fronts_.list)
      if (!eliminate_front(front, at, team_)) return false;
    return true;
  }

  /// Branches at once, each by one thread, then what is above them by all: every front takes the
  /// same rests in the same order as one after the other.
  bool eliminate_branches() {
    const auto eliminate = [this](std::size_t task, int worker) {
      const Branch& branch = branches_.list[task];
      WorkPlace& at = work_places_[index(worker)];
      at.clear();
      done_[task] = 0;
      for (std::size_t f = branch.first; f < branch.end; ++f)
        if (!eliminate_front(fronts_.list[f], at, {})) return;
      std::ranges::copy_n(at.stack.data(), static_cast<std::ptrdiff_t>(rests_[task].size()),
                          rests_[task].data());
      done_[task] = 1;
    };
    threads_->run(branches_.list.size(), std::ref(eliminate));
    if (std::ranges::find(done_, 0) != done_.end()) return false;
    WorkPlace& at = work_places_[0];
    at.clear();
    std::size_t next = 0;
    const auto pass = [&](std::size_t end) {  // branches that come before a front
      for (; next < branches_.list.size() && branches_.list[next].first < end; ++next)
        if (branches_.list[next].rest > 0)
          at.waiting.push_back(
              {&fronts_.list[branches_.list[next].end - 1], rests_[next].data(), 0});
    };
    for (const Front* front : branches_.others) {
      pass(index(front - fronts_.list.data()));
      if (!eliminate_front(*front, at, team_)) return false;
    }
    return true;
  }

  /// Rests that wait for their parents: on the worker's stack, or elsewhere.
  struct Waiting {
    const Front* front = nullptr;
    const double* values = nullptr;
    std::size_t stacked = 0;  // numbers
  };
  struct WorkPlace {  // of one worker
    std::vector<double> stack, rest, space, gathered;
    std::vector<Waiting> waiting;
    std::size_t top = 0;
    void clear() {
      waiting.clear();
      top = 0;
    }
  };

  bool eliminate_front(const Front& front, WorkPlace& at, const Team& team) {
    Block block = block_of(front), rest(at.rest.data(), front.rest(), front.rest());
    block.setZero();
    const std::size_t f = index(&front - fronts_.list.data());
    for (std::size_t k = first_entry_[f]; k < first_entry_[f + 1]; ++k)
      values_[to_[k]] = entry_[from_[k]];
    rest.setZero();
    for (int child = 0; child < front.children; ++child) {
      const Waiting from = at.waiting.back();
      at.waiting.pop_back();
      at.top -= from.stacked;
      add(*from.front, from.values, block, rest);
    }
    if (!eliminate_(block_view(block), block_view(rest), at.space.data(), team)) return false;
    if (front.rest() == 0) return true;
    double* to = at.stack.data() + at.top;
    std::ranges::copy_n(rest.data(), rest.size(), to);
    at.waiting.push_back({&front, to, index(rest.size())});
    at.top += index(rest.size());
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

  /// Calls `work(branch, its right sides, worker)` for all branches: by threads, if there are some.
  template <class Work>
  void for_branches(Eigen::Index count, const Work& work) {
    const auto one = [&](std::size_t task, int worker) {
      const Branch& branch = branches_.list[task];
      const std::size_t begin = branch.place * index(count);
      work(branch, Block(places_.data() + begin, branch.size(), count),
           work_places_[index(worker)].gathered.data());
    };
    if (threads_ != nullptr) return threads_->run(branches_.list.size(), std::ref(one));
    for (std::size_t task = 0; task < branches_.list.size(); ++task) one(task, 0);
  }

  /// Right sides (n, count), and their answers. What branches leave is added up in their order.
  void solve_some(const double* b, double* x, Eigen::Index count) {
    const Eigen::Index n = static_cast<Eigen::Index>(fronts_.order.size());
    const int* order = fronts_.order.data();
    make_room(n, count);
    Block work(work_.data(), n, count);
    for_branches(count, [&](const Branch& branch, Block own, double* gathered) {
      for (Eigen::Index c = 0; c < count; ++c)
        for (int k = 0; k < branch.columns; ++k)
          own(k, c) = b[order[branch.first_column + k] + c * n];
      own.bottomRows(branch.rest).setZero();
      for (std::size_t f = branch.first; f < branch.end; ++f)
        go_forward(fronts_.list[f], branch.first_column, own, gathered);
    });
    for (const Front* front : branches_.others)
      for (Eigen::Index c = 0; c < count; ++c)
        for (int k = front->first; k < front->first + front->columns; ++k)
          work(k, c) = b[order[k] + c * n];
    for (const Branch& branch : branches_.list) {
      const Block own(places_.data() + branch.place * index(count), branch.size(), count);
      const int* row = rows_left(branch);
      for (Eigen::Index c = 0; c < count; ++c)
        for (int k = 0; k < branch.rest; ++k) work(row[k], c) += own(branch.columns + k, c);
    }
    solve_top(work);
    for (const Front* front : branches_.others)
      for (Eigen::Index c = 0; c < count; ++c)
        for (int k = front->first; k < front->first + front->columns; ++k)
          x[order[k] + c * n] = work(k, c);
    for_branches(count, [&](const Branch& branch, Block own, double* gathered) {
      const int* row = rows_left(branch);
      for (Eigen::Index c = 0; c < count; ++c)
        for (int k = 0; k < branch.rest; ++k) own(branch.columns + k, c) = work(row[k], c);
      for (std::size_t f = branch.end; f-- > branch.first;)
        go_back(fronts_.list[f], branch.first_column, own, gathered);
      for (Eigen::Index c = 0; c < count; ++c)
        for (int k = 0; k < branch.columns; ++k)
          x[order[branch.first_column + k] + c * n] = own(k, c);
    });
  }

  void make_room(Eigen::Index n, Eigen::Index count) {
    work_.resize(std::max(work_.size(), n * count));
    places_.resize(std::max(places_.size(), branches_.places * index(count)));
    const std::size_t most = fronts_.longest * index(count);
    for (WorkPlace& at : work_places_) at.gathered.resize(std::max(at.gathered.size(), most));
  }
  void solve_top(Block& work) {
    double* gathered = work_places_[0].gathered.data();
    const std::vector<const Front*>& others = branches_.others;
    for (const Front* front : others) go_forward(*front, 0, work, gathered);
    for (auto front = others.rbegin(); front != others.rend(); ++front)
      go_back(**front, 0, work, gathered);
  }
  /// In the order of elimination: those that a branch's last front leaves.
  const int* rows_left(const Branch& branch) const {
    const Front& root = fronts_.list[branch.end - 1];
    return fronts_.rows.data() + root.list + root.columns;
  }

  /// Of x, whose first row is that of a column. Right sides that have nothing at a front's columns
  /// pass: forces on a surface meet few fronts.
  void go_forward(const Front& front, int first, Block& x, double* gathered) {
    auto own = x.middleRows(front.first - first, front.columns);
    if (own.isZero(0.0)) return;
    Block values(gathered, front.rows, x.cols());
    values.topRows(front.columns) = own;
    values.bottomRows(front.rest()).setZero();
    Block block = block_of(front);
    substitution_.forward(block_view(block), block_view(values));
    own = values.topRows(front.columns);
    const int* row = branches_.rows.data() + front.list;
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      for (int k = front.columns; k < front.rows; ++k) x(row[k], c) += values(k, c);
  }
  void go_back(const Front& front, int first, Block& x, double* gathered) {
    Block values(gathered, front.rows, x.cols());
    const int* row = branches_.rows.data() + front.list;
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      for (int k = 0; k < front.rows; ++k) values(k, c) = x(row[k], c);
    Block block = block_of(front);
    substitution_.backward(block_view(block), block_view(values));
    x.middleRows(front.first - first, front.columns) = values.topRows(front.columns);
  }

  Pivots pivots_;
  WorkerThreads* threads_ = nullptr;  // null: there is one
  Team team_;
  Fronts fronts_;
  Branches branches_;
  Eigen::Index entries_ = -1;               // of the matrix
  const double* entry_ = nullptr;           // of the matrix that is being factored
  std::vector<int> from_;                   // of its lower half, in the order of elimination
  std::vector<std::size_t> to_;             // among the values
  std::vector<std::size_t> first_entry_;    // (fronts and one) of these
  std::vector<double> values_;              // of the factor
  std::vector<WorkPlace> work_places_;      // (workers)
  std::vector<std::vector<double>> rests_;  // (branches) that wait for their parents
  std::vector<char> done_;                  // (branches)
  Eliminate& eliminate_ = eliminate_here();
  const FrontSubstitution& substitution_ = substitution_here();
  Vector work_;                                // right sides in the order of elimination
  std::vector<double> places_;                 // the same of branches, each with what it leaves
  static constexpr Eigen::Index together = 8;  // that stay in the cache beside a front's columns
};

}  // namespace

std::unique_ptr<LinearSolver> make_multifrontal_solver(Pivots pivots, WorkerThreads* threads) {
  return std::make_unique<Multifrontal>(pivots, threads);
}

}  // namespace abut
