#include "subdomain_solver/fe/cell_answers.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/vector_units.hpp"
#include "subdomain_solver/fe/batched_law.hpp"

namespace abut {

const StiffnessKernels& stiffness_here() {
#ifdef __x86_64__
  if (has_x86_64_v4()) return stiffness_avx512;
  if (has_x86_64_v3()) return stiffness_avx2;
#endif
  return stiffness_generic;
}

namespace {

/// Tasks of 8 cells that several threads share before answers are added up: enough work for a
/// moment, and answers that stay in the second cache.
constexpr int shared_tasks = 32;

/// Numbers of cells side by side; those of the last stand in for cells that there are not.
void lay_out(const double* of_first, int numbers, int cells, double* out) {
  for (int l = 0; l < batch_lanes; ++l) {
    const double* from = of_first + index(std::min(l, cells - 1)) * index(numbers);
    for (int k = 0; k < numbers; ++k) out[k * batch_lanes + l] = from[k];
  }
}

/// A cell's tangent from its pairs of nodes.
void spread_pairs(const double* pairs, int nodes, int dim, Eigen::MatrixXd& out) {
  out.resize(nodes * dim, nodes * dim);
  for (int a = 0; a < nodes; ++a)
    for (int b = a; b < nodes; ++b)
      for (int i = 0; i < dim; ++i)
        for (int k = 0; k < dim; ++k, pairs += batch_lanes) {
          out(a * dim + i, b * dim + k) = *pairs;
          out(b * dim + k, a * dim + i) = *pairs;
        }
}

}  // namespace

CellAnswers::CellAnswers(const Material& material, const FeOptions& options, int dim,
                         WorkerThreads* threads, bool batches)
    : threads_(threads != nullptr ? *threads : own_.emplace(options.threads)),
      one_volume_(options.formulation == Formulation::mean_dilatation) {
  for (int k = 0; k < threads_.count(); ++k) workers_.emplace_back(material);
  most_ = batch_lanes * (threads_.count() > 1 ? shared_tasks : 1);
  answers_.resize(index(most_));
  answered_.resize(index(most_ / batch_lanes));
  const std::optional<BatchedLaw> law = batched_law_of(material);
  if (!batches || !law || options.formulation == Formulation::one_point) return;
  stiffness_ = stiffness_here().of(*law, dim, one_volume_);
  parameters_.moduli = material.moduli();
}

void CellAnswers::guard(bool on) {
  guarded_ = on;
  for (Worker& worker : workers_) worker.kernel.guard(on);
}

bool CellAnswers::batched(const CellMeasures& measures) const {
  const int fields = one_volume_ && measures.points > 1 ? 1 : 0;
  return stiffness_ != nullptr && !guarded_ && measures.fields == fields;
}

template <class Answer>
bool CellAnswers::ask_all(const CellsAsked& asked, const Answer& answer) {
  const std::size_t tasks = index((asked.count + batch_lanes - 1) / batch_lanes);
  const auto ask = [this, &answer](std::size_t task, int worker) {
    answer(task, workers_[index(worker)]);
  };
  // Handed on by reference: a copy of what the lambda holds would be allocated.
  threads_.run(tasks, std::ref(ask));
  return std::find(answered_.begin(), answered_.begin() + static_cast<std::ptrdiff_t>(tasks), 0) ==
         answered_.begin() + static_cast<std::ptrdiff_t>(tasks);
}

bool CellAnswers::evaluate(const CellsAsked& asked, Need need) {
  return ask_all(asked,
                 [&](std::size_t task, Worker& worker) { answer(asked, need, task, worker); });
}

bool CellAnswers::find_tangents(const CellsAsked& asked) {
  return ask_all(asked,
                 [&](std::size_t task, Worker& worker) { find_tangents(asked, task, worker); });
}

void CellAnswers::answer(const CellsAsked& asked, Need need, std::size_t task, Worker& worker) {
  const std::size_t numbers = index(asked.measures.points * worker.kernel.history_size());
  const int end = std::min(asked.count, static_cast<int>(task + 1) * batch_lanes);
  answered_[task] = 0;
  for (int k = static_cast<int>(task) * batch_lanes; k < end; ++k) {
    asked.displacement(asked.first + k, worker.one);
    const std::size_t at = index(k) * numbers;
    if (!worker.kernel.evaluate(asked.measures.of(asked.first + k), worker.one,
                                asked.before.subspan(at, numbers), asked.after.subspan(at, numbers),
                                need, answers_[index(k)]))
      return;
  }
  answered_[task] = 1;
}

void CellAnswers::find_tangents(const CellsAsked& asked, std::size_t task, Worker& worker) {
  const CellMeasures& m = asked.measures;
  const int begin = static_cast<int>(task) * batch_lanes;
  const int cells = std::min(batch_lanes, asked.count - begin), each = m.nodes * m.dim;
  const auto fit = [](std::vector<double>& list, int numbers) {
    list.resize(index(numbers * batch_lanes));
    return list.data();
  };
  const std::size_t first = index(asked.first + begin);
  double* displacement = fit(worker.displacement, each);
  for (int l = 0; l < batch_lanes; ++l) {
    if (l < cells) asked.displacement(asked.first + begin + l, worker.one);
    for (int k = 0; k < each; ++k) displacement[k * batch_lanes + l] = worker.one[index(k)];
  }
  double* volume = fit(worker.volume, m.points);
  lay_out(m.volume.data() + first * index(m.points), m.points, cells, volume);
  double* gradient = fit(worker.gradient, m.points * each);
  lay_out(m.gradient.data() + first * index(m.points * each), m.points * each, cells, gradient);
  const int pairs = m.nodes * (m.nodes + 1) / 2;
  double* stiffness = fit(worker.stiffness, pairs * m.dim * m.dim);
  answered_[task] =
      stiffness_({m.nodes, m.points, volume, gradient, displacement, stiffness}, parameters_);
  for (int l = 0; l < cells; ++l)
    spread_pairs(stiffness + l, m.nodes, m.dim, answers_[index(begin + l)].tangent);
}

}  // namespace abut
