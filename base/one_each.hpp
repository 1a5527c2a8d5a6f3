#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace abut {

/// Sorts by key and leaves one value of each.
template <class T, class Key = std::identity>
void keep_one_each(std::vector<T>& values, Key key = {}) {
  std::ranges::sort(values, {}, key);
  const auto same = [&key](const T& a, const T& b) {
    return std::invoke(key, a) == std::invoke(key, b);
  };
  values.erase(std::unique(values.begin(), values.end(), same), values.end());
}

}  // namespace abut
