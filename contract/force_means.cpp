#include "contract/force_means.hpp"

#include <algorithm>

namespace abut {

std::vector<double> levels_of(const Substeps& grid) {
  std::vector<double> levels = {grid.begin};
  for (int i = 1; i <= grid.count; ++i) levels.push_back(grid.time(i));
  return levels;
}

std::vector<double> force_means(std::span<const double> here, std::span<const double> source) {
  const std::size_t rows = here.size(), columns = source.size();
  std::vector<double> parts(rows * columns, 0.0);
  const bool same = std::ranges::equal(here, source);
  for (std::size_t b = 0; b < rows; ++b) {
    if (same || columns < 2 || rows < 2) {
      parts[b * columns + std::min(b, columns - 1)] = 1.0;
      continue;
    }
    const double from = b == 0 ? here[0] : 0.5 * (here[b - 1] + here[b]);
    const double to = b + 1 == rows ? here[b] : 0.5 * (here[b] + here[b + 1]);
    for (std::size_t j = 0; j + 1 < columns; ++j) {
      const double begin = std::max(from, source[j]), end = std::min(to, source[j + 1]);
      if (end <= begin) continue;
      const double share = (end - begin) / (to - from);
      const double middle = (0.5 * (begin + end) - source[j]) / (source[j + 1] - source[j]);
      parts[b * columns + j] += share * (1.0 - middle);
      parts[b * columns + j + 1] += share * middle;
    }
  }
  return parts;
}

}  // namespace abut
