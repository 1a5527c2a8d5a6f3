#include "coordinator/prediction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coordinator/record/shares.hpp"
#include "coordinator/record/time_words.hpp"

namespace abut {

namespace {

/// [s] of the clock per second of the scene's time: of windows in contact, and of others.
struct Rates {
  std::optional<double> closed, free;
  double both = 0.0;        // as they came
  double iterations = 1.0;  // of windows in contact, on average
};

/// Of the last half of the probe: kernels are there, and as many points press as later on.
Rates rates_of(const ProbedRun& probe) {
  double half = 0.0;
  for (const ProbedRun::Stretch& s : probe.stretches) half += 0.5 * s.wall;
  double wall[2] = {0.0, 0.0}, time[2] = {0.0, 0.0}, iterations = 0.0, closed = 0.0;
  double seen = 0.0;
  for (std::size_t k = probe.stretches.size(); k-- > 0;) {
    const ProbedRun::Stretch& s = probe.stretches[k];
    const bool early = seen + 0.5 * s.wall > half;
    seen += s.wall;
    if (early && time[s.closed] > 0.0) continue;  // of a kind that has not come later: all there is
    wall[s.closed] += s.wall;
    time[s.closed] += s.length;
    if (s.closed) {
      iterations += s.iterations;
      closed += 1.0;
    }
  }
  Rates rates;
  if (time[1] > 0.0) rates.closed = wall[1] / time[1];
  if (time[0] > 0.0) rates.free = wall[0] / time[0];
  rates.both = (wall[0] + wall[1]) / (time[0] + time[1]);
  if (closed > 0.0) rates.iterations = iterations / closed;
  return rates;
}

/// [s] of the clock to write the states of fields in so much of the scene's time.
double fields_seconds(const ProbedRun& probe, double time) {
  return probe.states_apart > 0.0 ? time / probe.states_apart * probe.state_wall : 0.0;
}

}  // namespace

std::optional<Prediction> predict(const ProbedRun& probe, double end, double startup,
                                  const ContactOutlook& outlook) {
  if (probe.whole) {
    const double seconds = startup + probe.wall;
    return Prediction{seconds, seconds, seconds, true};
  }
  if (probe.stretches.empty()) return std::nullopt;
  const Rates rates = rates_of(probe);
  const double left = std::max(0.0, end - probe.reached);
  const double spent = startup + probe.wall + fields_seconds(probe, left);
  const auto with = [&](double rate) { return spent + left * rate; };
  if (outlook.tied || !outlook.possible) {
    const double seconds = with(rates.both);
    return Prediction{seconds, seconds, seconds, false};
  }
  const double free = rates.free.value_or(rates.closed.value_or(0.0) / rates.iterations);
  const double closed = rates.closed.value_or(free * outlook.sweeps);
  Prediction out{0.0, with(std::min(free, closed)), with(std::max(free, closed)), false};
  if (outlook.lasting && probe.stretches.back().closed) out.low = out.high = with(closed);
  out.seconds = std::sqrt(out.low * out.high);
  return out;
}

std::string dear_words(const ProbedRun& probe, std::span<const std::string> bodies) {
  return shares_words(shares_of(probe.waited_seconds, probe.wall), bodies);
}

std::string to_text(const Prediction& prediction, const ProbedRun& probe, double end,
                    double memory_mib, std::size_t processes) {
  std::string text = fmt::format("  time       about {}", time_words(prediction.seconds));
  if (prediction.high > 1.3 * prediction.low)
    text += fmt::format(", {} to {} as contact goes on", time_words(prediction.low),
                        time_words(prediction.high));
  const auto closed = std::ranges::count_if(probe.stretches, &ProbedRun::Stretch::closed);
  const std::string seen =
      prediction.exact ? "the probe was all of the run"
                       : fmt::format("the probe saw {:.2g} % of it in {}, {} windows in contact",
                                     100.0 * (probe.reached - probe.begin) / (end - probe.begin),
                                     time_words(probe.wall), closed);
  text += fmt::format("; {}\n", seen);
  if (!prediction.exact && closed == 0 && prediction.high > prediction.low)
    text +=
        "             nothing pressed yet: windows in contact may cost more; a longer --probe "
        "sees them\n";
  const double fields = fields_seconds(probe, end - probe.begin);
  if (fields > 0.1 * prediction.seconds)
    text += fmt::format(
        "  fields     about {} of that to write their files; output.fields.every: a "
        "larger number takes less\n",
        time_words(fields));
  text += fmt::format("  memory     about {:.0f} MiB in {} processes\n", memory_mib, processes);
  return text;
}

}  // namespace abut
