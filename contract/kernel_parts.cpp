#include "contract/kernel_parts.hpp"

#include <algorithm>
#include <array>
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

}  // namespace

std::size_t bytes_of_pattern(const PortKernel& kernel) {
  return kernel.patterns > 0 ? values_of(kernel) * sizeof(double) / index(kernel.patterns) : 0;
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
  for (const auto array : arrays)
    (whole.*array).assign((part.*array).size() / index(part.patterns) * index(patterns), 0.0);
  return whole;
}

PortKernel part_of(const PortKernel& whole, int first, int count) {
  ABUT_ASSERT(first >= 0 && count > 0 && first + count <= whole.patterns);
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
  return first >= 0 && part.patterns > 0 && first + part.patterns <= whole.patterns &&
         part.width == whole.width && part.points == whole.points &&
         part.support == whole.support && std::ranges::all_of(arrays, alike);
}

void put(const PortKernel& part, int first, PortKernel& whole) {
  ABUT_ASSERT(fits(part, first, whole));
  const Copy copy{index(part.patterns),
                  index(part.width),
                  {index(part.patterns), 0},
                  {index(whole.patterns), index(first)}};
  for (const auto array : arrays) copy(part.*array, whole.*array);
}

}  // namespace abut
