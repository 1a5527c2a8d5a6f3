#include "subdomain_solver/fe/cell_keys.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

namespace {

constexpr int key_digits = 36;

}  // namespace

std::size_t CellKeys::Hash::operator()(const Key& key) const {
  std::size_t sum = 0;
  for (const std::int64_t part : key) sum = (sum ^ index(part)) * 0x9e3779b97f4a7c15ull;
  return sum ^ sum >> 29;
}

const CellKeys::Key& CellKeys::of(int cell, std::span<const double> u) {
  const int exponent = size_of(cell);
  key_.assign(1, exponent);
  append(mesh_.points, cell, exponent);
  if (!u.empty()) append(u, cell, exponent);
  return key_;
}

void CellKeys::append(std::span<const double> values, int cell, int exponent) {
  const std::size_t n = index(cells_.element->nodes), first = index(cell) * n;
  const std::size_t dim = index(mesh_.dim);
  const double* origin = values.data() + index(cells_.nodes[first]) * dim;
  for (std::size_t a = 1; a < n; ++a) {
    const double* at = values.data() + index(cells_.nodes[first + a]) * dim;
    for (std::size_t i = 0; i < dim; ++i)
      key_.push_back(std::llround(std::ldexp(at[i] - origin[i], key_digits - exponent)));
  }
}

/// Exponent of two of the cell's size.
int CellKeys::size_of(int cell) const {
  const std::size_t n = index(cells_.element->nodes), first = index(cell) * n;
  const std::size_t dim = index(mesh_.dim), origin = index(cells_.nodes[first]) * dim;
  double size = 0.0;
  for (std::size_t k = 0; k < n * dim; ++k) {
    const std::size_t at = index(cells_.nodes[first + k / dim]) * dim + k % dim;
    size = std::max(size, std::abs(mesh_.points[at] - mesh_.points[origin + k % dim]));
  }
  return std::ilogb(size) + 1;
}

}  // namespace abut
