#include "subdomain_solver/time/problem.hpp"
#include "base/index.hpp"

#include <cmath>

namespace abut {

namespace {

/// Of second order, from the value now and after three steps [s].
double one_sided_acceleration(const Prescribed& p, double time, double step) {
  const double at = p.value(time), one = p.value(time + step) - at,
               two = p.value(time + 2.0 * step) - at, three = p.value(time + 3.0 * step) - at;
  return (4.0 * two - 5.0 * one - three) / (step * step);
}

}  // namespace

const Vector& Problem::external_force(double time, std::span<const double> q) const {
  external_.setZero(model->dofs());
  for (const std::unique_ptr<Load>& load : loads) load->add(time, q, external_);
  return external_;
}

void Problem::set_rates(double time, double step, Motion& motion) const {
  const double h = 1.0e-3 * step;
  motion.a.resize(motion.q.size(), 0.0);
  for (const Prescribed& p : supports) {
    const std::size_t i = index(p.dof);
    const double at = p.value(time), next = p.value(time + h), last = p.value(time + 2.0 * h);
    motion.v[i] = (4.0 * (next - at) - (last - at)) / (2.0 * h);
    const double a = one_sided_acceleration(p, time, step);
    motion.a[i] = std::isfinite(a) ? a : 0.0;  // it may have no value some steps later
  }
}

void Problem::set_accelerations(double time, double step, Vector& acceleration) const {
  for (const Prescribed& p : supports) {
    const double at = p.value(time), next = p.value(time + step), last = p.value(time - step);
    double a = ((next - at) - (at - last)) / (step * step);
    if (!std::isfinite(a)) a = one_sided_acceleration(p, time, step);  // none before the begin
    if (!std::isfinite(a)) a = one_sided_acceleration(p, time, -step);
    acceleration(p.dof) = std::isfinite(a) ? a : 0.0;
  }
}

FreeCoordinates::FreeCoordinates(int dofs, const std::vector<Prescribed>& supports,
                                 const std::vector<int>& without)
    : place_(index(dofs), 0) {
  for (const Prescribed& p : supports) place_[p.dof] = -1;
  for (const int dof : without) place_[dof] = -1;
  for (int i = 0; i < dofs; ++i) {
    int& place = place_[i];
    if (place < 0) continue;
    place = count();
    free_.push_back(i);
  }
}

void FreeCoordinates::pick(const Vector& all, Vector& free) const {
  free.resize(count());
  for (int i = 0; i < count(); ++i) free(i) = all(free_[i]);
}

void FreeCoordinates::add(const Vector& free, Vector& all) const {
  for (int i = 0; i < count(); ++i) all(free_[i]) += free(i);
}

void FreeCoordinates::extract(const SparseMatrix& all, SparseMatrix& free) {
  if (entries_ != all.nonZeros()) {  // a new pattern
    entries_ = all.nonZeros();
    from_.clear();
    std::vector<Eigen::Triplet<double>> entries;
    for (int column : free_) {
      const int first = all.outerIndexPtr()[column], last = all.outerIndexPtr()[column + 1];
      for (int k = first; k < last; ++k) {
        const int row = place_[all.innerIndexPtr()[k]];
        if (row < 0) continue;
        entries.emplace_back(row, place_[column], 0.0);
        from_.push_back(k);
      }
    }
    free.resize(count(), count());
    free.setFromTriplets(entries.begin(), entries.end());
  }
  for (std::size_t k = 0; k < from_.size(); ++k) free.valuePtr()[k] = all.valuePtr()[from_[k]];
}

}  // namespace abut
