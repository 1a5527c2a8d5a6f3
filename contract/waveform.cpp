#include "contract/waveform.hpp"

#include <algorithm>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

/// Index of the last stored time that is not after `at`, limited so that a successor exists.
std::size_t interval_of(const std::vector<double>& time, double at) {
  const auto after = std::upper_bound(time.begin(), time.end(), at);
  const std::size_t next = index(after - time.begin());
  return std::clamp<std::size_t>(next, 1, time.size() - 1) - 1;
}

}  // namespace

void Waveform::clear() {
  points.clear();
  time.clear();
  u.clear();
  v.clear();
  a.clear();
  f.clear();
}

void Waveform::interpolate(const std::vector<double>& field, double at,
                           std::span<double> out) const {
  const std::size_t w = index(width);
  ABUT_ASSERT(!time.empty() && field.size() == time.size() * w && out.size() == w);
  if (time.size() == 1 || at <= time.front()) {
    std::copy_n(field.begin(), w, out.begin());
    return;
  }
  if (at >= time.back()) {
    std::copy_n(field.end() - width, w, out.begin());
    return;
  }
  const std::size_t i = interval_of(time, at);
  const double s = (at - time[i]) / (time[i + 1] - time[i]);
  for (std::size_t c = 0; c < w; ++c) {
    const double before = field[i * w + c];
    out[c] = before + s * (field[(i + 1) * w + c] - before);
  }
}

void Waveform::interpolate(const std::vector<double>& field, double at,
                           std::span<const std::size_t> values, std::span<double> out) const {
  const std::size_t w = index(width);
  ABUT_ASSERT(!time.empty() && field.size() == time.size() * w && out.size() == values.size());
  const bool first = time.size() == 1 || at <= time.front();
  if (first || at >= time.back()) {
    const double* row = field.data() + (first ? 0 : field.size() - w);
    for (std::size_t k = 0; k < values.size(); ++k) out[k] = row[values[k]];
    return;
  }
  const std::size_t i = interval_of(time, at);
  const double s = (at - time[i]) / (time[i + 1] - time[i]);
  const double *before = field.data() + i * w, *after = before + w;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::size_t c = values[k];
    out[k] = before[c] + s * (after[c] - before[c]);
  }
}

void Waveform::force_at(double at, std::span<double> out) const {
  if (support != ForceSupport::step) {
    interpolate(f, at, out);
    return;
  }
  ABUT_ASSERT(!time.empty() && f.size() == time.size() * index(width) &&
              out.size() == index(width));
  // The force of a substep belongs to the half-open interval that ends at its stored time.
  const auto not_before = std::lower_bound(time.begin(), time.end(), at);
  const std::size_t last = time.size() - 1;
  const std::size_t first = std::min<std::size_t>(1, last);
  const std::size_t i = std::clamp(index(not_before - time.begin()), first, last);
  std::copy_n(f.begin() + static_cast<std::ptrdiff_t>(i) * width, width, out.begin());
}

void Waveform::impulse(double from, double to, std::span<double> out) const {
  const std::size_t w = index(width);
  ABUT_ASSERT(f.size() == time.size() * w && out.size() == w);
  std::fill_n(out.begin(), w, 0.0);
  if (time.size() < 2) return;
  const std::size_t last = time.size() - 1;
  if (support == ForceSupport::linear) return linear_impulse(from, to, out);
  const bool nodal = support == ForceSupport::nodal;
  // Cell i is [begin_of(i), begin_of(i + 1)]: dual cells of all nodes, or the substeps 1..last.
  auto begin_of = [this, nodal, last](std::size_t i) {
    if (!nodal) return time[i - 1];
    if (i == 0) return time.front();
    return i > last ? time.back() : 0.5 * (time[i - 1] + time[i]);
  };
  for (std::size_t i = interval_of(time, from) + (nodal ? 0 : 1); i <= last; ++i) {
    const double cell_begin = begin_of(i);
    if (cell_begin >= to) break;
    const double cell_end = nodal ? begin_of(i + 1) : time[i];
    const double overlap = std::min(cell_end, to) - std::max(cell_begin, from);
    if (overlap <= 0.0) continue;
    for (std::size_t c = 0; c < w; ++c) out[c] += overlap * f[i * w + c];
  }
}

void Waveform::linear_impulse(double from, double to, std::span<double> out) const {
  const std::size_t w = index(width);
  for (std::size_t i = interval_of(time, from); i + 1 < time.size() && time[i] < to; ++i) {
    const double begin = std::max(from, time[i]), end = std::min(to, time[i + 1]);
    if (end <= begin) continue;
    const double middle = (0.5 * (begin + end) - time[i]) / (time[i + 1] - time[i]);
    for (std::size_t c = 0; c < w; ++c)
      out[c] += (end - begin) * ((1.0 - middle) * f[i * w + c] + middle * f[(i + 1) * w + c]);
  }
}

}  // namespace abut
