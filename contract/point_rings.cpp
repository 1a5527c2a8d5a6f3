#include "contract/point_rings.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {

PointRings::PointRings(int points, std::span<const std::int32_t> facets,
                       std::span<const std::int32_t> offsets, std::span<const std::int32_t> among) {
  std::vector<std::int32_t> number(index(points), among.empty() ? 0 : -1);
  for (std::size_t p = 0; p < (among.empty() ? number.size() : among.size()); ++p)
    number[among.empty() ? p : index(among[p])] = static_cast<std::int32_t>(p);
  const std::size_t count = among.empty() ? number.size() : among.size();
  std::vector<std::vector<std::int32_t>> lists(count);
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    const std::span<const std::int32_t> nodes =
        facets.subspan(index(offsets[f]), index(offsets[f + 1] - offsets[f]));
    for (const std::int32_t a : nodes)
      for (const std::int32_t b : nodes)
        if (a != b && number[index(a)] >= 0 && number[index(b)] >= 0)
          lists[index(number[index(a)])].push_back(number[index(b)]);
  }
  first_.assign(1, 0);
  for (std::vector<std::int32_t>& list : lists) {
    keep_one_each(list);
    neighbours_.insert(neighbours_.end(), list.begin(), list.end());
    first_.push_back(static_cast<std::int32_t>(neighbours_.size()));
  }
  seen_.assign(count, 0);
}

std::span<const std::int32_t> PointRings::around(std::int32_t point, int rings) {
  ++call_;
  found_.assign(1, point);
  seen_[index(point)] = call_;
  std::size_t from = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t to = found_.size();
    for (; from < to; ++from) {
      const std::size_t p = index(found_[from]);
      for (std::int32_t k = first_[p]; k < first_[p + 1]; ++k) {
        const std::int32_t q = neighbours_[index(k)];
        if (seen_[index(q)] == call_) continue;
        seen_[index(q)] = call_;
        found_.push_back(q);
      }
    }
  }
  std::ranges::sort(found_);
  return found_;
}

std::vector<int> PointRings::colours(int rings) {
  std::vector<int> colours(index(count()), -1), taken;
  for (std::int32_t p = 0; p < count(); ++p) {
    taken.clear();
    for (const std::int32_t q : around(p, 2 * rings))
      if (colours[index(q)] >= 0) taken.push_back(colours[index(q)]);
    keep_one_each(taken);
    int free = 0;
    while (index(free) < taken.size() && taken[index(free)] == free) ++free;
    colours[index(p)] = free;
  }
  return colours;
}

}  // namespace abut
