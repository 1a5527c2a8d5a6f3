#include "contract/kernel_parts.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/assert.hpp"

namespace abut {

namespace {

constexpr std::array arrays = {&PortKernel::compliance, &PortKernel::displacement,
                               &PortKernel::begin};

/// From (rows, of, width) to (rows, to, width): `count` patterns, from one place to another.
struct Copy {
  std::size_t count, width;
  struct End {
    std::size_t patterns, first;
  } from, to;

  void operator()(const std::vector<double>& source, std::vector<double>& target) const {
    const std::size_t rows = source.size() / (from.patterns * width);
    for (std::size_t r = 0; r < rows; ++r)
      std::copy_n(source.data() + (r * from.patterns + from.first) * width, count * width,
                  target.data() + (r * to.patterns + to.first) * width);
  }
};

std::size_t values_of(const PortKernel& kernel) {
  std::size_t values = 0;
  for (const auto array : arrays) values += (kernel.*array).size();
  return values;
}

/// Of a banded kernel: entries of its points [first, first + count).
struct Entries {
  std::size_t first, count;
};

Entries entries_of(const KernelBand& band, std::size_t first, std::size_t count) {
  const std::size_t begin = index(band.offsets[first]);
  return {begin, index(band.offsets[first + count]) - begin};
}

PortKernel banded_part_of(const PortKernel& whole, int first, int count) {
  PortKernel part = room_for(whole, count);
  const std::size_t dim = index(whole.band.dim), each = dim * dim;
  ABUT_ASSERT(index(first) % dim == 0 && index(count) % dim == 0);
  const auto [begin, some] = entries_of(whole.band, index(first) / dim, index(count) / dim);
  const auto from = whole.band.reached.begin() + static_cast<std::ptrdiff_t>(begin);
  part.band.reached.assign(from, from + static_cast<std::ptrdiff_t>(some));
  for (std::size_t p = 0; p < index(count) / dim; ++p)
    part.band.offsets.push_back(whole.band.offsets[index(first) / dim + p + 1] -
                                static_cast<std::int32_t>(begin));
  for (const auto array : arrays) {
    const std::vector<double>& values = whole.*array;
    for (std::size_t at = 0; at < values.size(); at += whole.per_step()) {
      const auto row = values.begin() + static_cast<std::ptrdiff_t>(at + begin * each);
      (part.*array)
          .insert((part.*array).end(), row, row + static_cast<std::ptrdiff_t>(some * each));
    }
  }
  return part;
}

/// Parts follow one another.
void append(const PortKernel& part, PortKernel& whole) {
  const std::size_t each = index(part.band.dim * part.band.dim),
                    before = whole.band.reached.size() * each,
                    more = part.band.reached.size() * each;
  for (const auto array : arrays) {
    const std::vector<double>& from = part.*array;
    std::vector<double>& to = whole.*array;
    const std::size_t rows = from.size() / more;
    if (rows == 1) {  // in place
      to.insert(to.end(), from.begin(), from.end());
      continue;
    }
    std::vector<double> both;
    both.reserve(to.size() + from.size());
    for (std::size_t r = 0; r < rows; ++r) {
      const auto old = to.begin() + static_cast<std::ptrdiff_t>(r * before);
      const auto add = from.begin() + static_cast<std::ptrdiff_t>(r * more);
      both.insert(both.end(), old, old + static_cast<std::ptrdiff_t>(before));
      both.insert(both.end(), add, add + static_cast<std::ptrdiff_t>(more));
    }
    to = std::move(both);
  }
  const auto first = static_cast<std::int32_t>(whole.band.reached.size());
  for (std::size_t p = 1; p < part.band.offsets.size(); ++p)
    whole.band.offsets.push_back(first + part.band.offsets[p]);
  whole.band.reached.insert(whole.band.reached.end(), part.band.reached.begin(),
                            part.band.reached.end());
}

/// Of what has been put so far.
bool follows(const PortKernel& part, int first, const PortKernel& whole) {
  if (part.band.empty() || part.band.reached.empty() || part.patterns <= 0 || first < 0 ||
      first + part.patterns > whole.patterns || part.width != whole.width ||
      part.points != whole.points || part.support != whole.support)
    return false;
  const std::size_t dim = index(part.band.dim), placed = whole.band.points();
  if (dim == 0 || part.band.dim != whole.band.dim || placed * dim != index(first)) return false;
  const auto rows = [dim](const PortKernel& kernel, const auto array) {
    return (kernel.*array).size() / (kernel.band.reached.size() * dim * dim);
  };
  return placed == 0 || std::ranges::all_of(arrays, [&](const auto array) {
           return rows(part, array) == rows(whole, array);
         });
}

}  // namespace

std::size_t bytes_of_pattern(const PortKernel& kernel) {
  if (kernel.patterns <= 0) return 0;
  return (values_of(kernel) * sizeof(double) + kernel.band.reached.size() * sizeof(std::int32_t)) /
         index(kernel.patterns);
}

PortKernel room_for(const PortKernel& part, int patterns) {
  PortKernel whole;
  whole.step = part.step;
  whole.support = part.support;
  whole.patterns = patterns;
  whole.width = part.width;
  whole.points = part.points;
  whole.carried = part.carried;
  whole.left = part.left;
  if (!part.band.empty()) {
    whole.band.dim = part.band.dim;
    whole.band.offsets = {0};
    return whole;
  }
  for (const auto array : arrays)
    (whole.*array).assign((part.*array).size() / index(part.patterns) * index(patterns), 0.0);
  return whole;
}

PortKernel part_of(const PortKernel& whole, int first, int count) {
  ABUT_ASSERT(first >= 0 && count > 0 && first + count <= whole.patterns);
  if (!whole.band.empty()) return banded_part_of(whole, first, count);
  PortKernel part = room_for(whole, count);
  const Copy copy{
      index(count), index(whole.width), {index(whole.patterns), index(first)}, {index(count), 0}};
  for (const auto array : arrays) copy(whole.*array, part.*array);
  return part;
}

bool fits(const PortKernel& part, int first, const PortKernel& whole) {
  const auto alike = [&](const auto array) {
    return (part.*array).size() * index(whole.patterns) ==
           (whole.*array).size() * index(part.patterns);
  };
  if (!whole.band.empty()) return follows(part, first, whole);
  return part.band.empty() && first >= 0 && part.patterns > 0 &&
         first + part.patterns <= whole.patterns && part.width == whole.width &&
         part.points == whole.points && part.support == whole.support &&
         std::ranges::all_of(arrays, alike);
}

void put(const PortKernel& part, int first, PortKernel& whole) {
  ABUT_ASSERT(fits(part, first, whole));
  if (!whole.band.empty()) return append(part, whole);
  const Copy copy{index(part.patterns),
                  index(part.width),
                  {index(part.patterns), 0},
                  {index(whole.patterns), index(first)}};
  for (const auto array : arrays) copy(part.*array, whole.*array);
}

}  // namespace abut
