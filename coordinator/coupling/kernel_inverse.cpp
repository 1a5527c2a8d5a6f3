#include "coordinator/coupling/kernel_inverse.hpp"

#include <cmath>
#include <utility>

#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {
/// Factored Jacobians kept per joint; windows cut short by events have lengths of their own.
constexpr std::size_t kept_inverses = 32;

/// Ends of windows are rounded: equal windows differ in their last bits.
bool same(double a, double b) { return std::abs(a - b) <= 1.0e-9 * b; }

}  // namespace

Eigen::VectorXd KernelInverse::Entry::solve(const Eigen::VectorXd& r) const {
  return column.empty() ? factors.solve(r) : solve_toeplitz(column, r);
}

const KernelInverse::Entry* KernelInverse::find(double length) const {
  for (const std::unique_ptr<Entry>& entry : entries_)
    if (same(entry->length, length)) return entry.get();
  return nullptr;
}

TimeWindow KernelInverse::first_of(const TimeWindow& window) {
  for (const TimeWindow& first : windows_)
    if (same(first.length(), window.length())) return first;
  if (windows_.size() >= kept_inverses) windows_.erase(windows_.begin() + 1);
  return windows_.emplace_back(window);
}

void KernelInverse::state(Archive& archive) {
  list(archive, "windows", windows_, [](Archive& a, TimeWindow& window) {
    a.field("begin", window.begin);
    a.field("end", window.end);
  });
}

const KernelInverse::Entry* KernelInverse::add(Entry entry) {
  // the first is the whole window's
  if (entries_.size() >= kept_inverses) entries_.erase(entries_.begin() + 1);
  entries_.push_back(std::make_unique<Entry>(std::move(entry)));
  return entries_.back().get();
}

const KernelInverse::Entry* KernelInverse::store(double length, const Eigen::MatrixXd& jacobian) {
  Entry entry{.length = length};
  entry.factors.compute(jacobian);
  return add(std::move(entry));
}

const KernelInverse::Entry* KernelInverse::store(double length, ContactMaps maps) {
  return add({.length = length, .maps = std::move(maps)});
}

const KernelInverse::Entry* KernelInverse::store(double length, std::vector<double> column) {
  return add({.length = length, .column = std::move(column)});
}

}  // namespace abut
