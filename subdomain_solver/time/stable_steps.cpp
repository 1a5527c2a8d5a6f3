#include "subdomain_solver/time/stable_steps.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/count.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

constexpr double part_of_limit = 0.95;  // that a part of a step takes
// Of the square of the limit: where growth is answered before the limit is reached, 2 % of the
// step; below which squares need not be told apart.
constexpr double near = 0.96, far = 0.8;
// Bounds are found to a hundredth, so they say nothing of smaller changes than two of them.
constexpr double resolution = 0.02;
constexpr double longest = 256.0;     // [steps] between bounds where nothing changes
constexpr double shortest = 4.0;      // [steps] at the begin, and where a refusal is near
constexpr double most_parts = 1.0e6;  // of a step: elements on the way to no size at all
constexpr double foresight = 1.5;     // share of the last growth that the next one may have
// Of the square, that is carried on to the next bound, which comes the earlier: a front that has
// doubled it in some steps would be carried on to any number by then.
constexpr double most_foreseen = 4.0;

}  // namespace

/// What is kept from step to step, in the motion's list.
struct StableSteps::Control {
  double &first, &square, &growth, &since, &interval, &stored, &parts, &limit, &most_parts;

  static constexpr std::size_t count = 9;
  explicit Control(std::vector<double>& list)
      : first(list[0]),     // [1/s^2] bound at the begin
        square(list[1]),    // [1/s^2] last bound
        growth(list[2]),    // [1] of its logarithm per step; 0: none to speak of
        since(list[3]),     // steps and parts since then
        interval(list[4]),  // to the next one
        stored(list[5]),    // [J] at the last one
        parts(list[6]),     // of a whole step
        limit(list[7]),     // [s] least so far
        most_parts(list[8]) {
    ABUT_ASSERT(list.size() == count);
  }
};

StableSteps::StableSteps(std::unique_ptr<Integrator> steps, std::unique_ptr<FrequencyWatch> watch,
                         const Options& options)
    : Integrator(abilities(*steps)),
      watch_(std::move(watch)),
      options_(options),
      steps_(std::move(steps)) {
  ABUT_ASSERT(steps_ != nullptr && watch_ != nullptr && options.step > 0.0 &&
              options.step <= options.limit);
}

Integrator::Abilities StableSteps::abilities(const Integrator& steps) {
  Abilities able = steps.able();
  if (able.foreseeing != nullptr) able.foreseeing = this;
  able.held = this;
  return able;
}

/// The square of the frequency at which a step of some parts is at its limit.
double StableSteps::square_of(double parts) const {
  const double frequency = 2.0 * parts / options_.step;
  return frequency * frequency;
}

std::optional<Failed> StableSteps::begin(Motion& motion, double time) {
  if (std::optional<Failed> failed = steps_->begin(motion, time)) return failed;
  const std::optional<FrequencyWatch::Bound> found = watch_->bound(
      motion.q, motion.history, far * square_of(1.0), FrequencyWatch::Effort::bounded);
  if (!found) return failed_newton({NewtonReport::End::inadmissible}, time);
  motion.control.assign(Control::count, 0.0);
  Control control(motion.control);
  control.first = control.square = found->square;
  control.interval = shortest;
  control.stored = motion.stored;
  control.parts = control.most_parts = 1.0;
  control.limit = options_.limit;
  return std::nullopt;
}

/// Whether a bound is to be found before the next step.
bool StableSteps::is_due(const Motion& motion, const Control& control) const {
  const bool stirred = motion.stored > 2.0 * control.stored;
  return control.since >= control.interval ||
         (stirred && control.since >= watch_->least_interval());
}

/// Equal ones, of a step of this length.
double StableSteps::parts_of(double dt, const Control& control) const {
  return std::ceil(control.parts * dt / options_.step - 1.0e-6);
}

bool StableSteps::foresee(const Motion& motion, double time, double dt, Foreseen& ahead) {
  control_ = motion.control;
  const Control control(control_);
  if (ahead.steps > 0 || is_due(motion, control) || parts_of(dt, control) > 1.0) return false;
  return steps_->able().foreseeing->foresee(motion, time, dt, ahead);
}

std::optional<Failed> StableSteps::step(Motion& motion, double time, double dt) {
  Control control(motion.control);
  if (is_due(motion, control)) {
    if (std::optional<Failed> failed = check(motion, time)) return failed;
  }
  const double needed = parts_of(dt, control);
  if (needed > most_parts) {
    return Failed{Failed::Cause::step_too_small, time,
                  fmt::format("the stable limit has fallen so far that a step of {:g} s would take "
                              "{:g} parts, more than {:g}: check loads and the law's range",
                              dt, needed, most_parts)};
  }
  const int parts = count_within(needed, 1, static_cast<int>(most_parts));
  if (parts > 1) before_ = motion;
  for (int k = 0; k < parts; ++k) {
    if (std::optional<Failed> failed = steps_->step(motion, time + k * (dt / parts), dt / parts)) {
      if (k > 0) motion = before_;
      return failed;
    }
  }
  control.since += parts;
  return std::nullopt;
}

std::optional<Failed> StableSteps::check(Motion& motion, double time) {
  Control control(motion.control);
  const double fall = control.growth < 0.0 ? far : 1.0 - resolution;
  const double from =
      std::max(far * square_of(std::max(1.0, control.parts - 1.0)), fall * control.square);
  const std::optional<FrequencyWatch::Bound> found =
      watch_->bound(motion.q, motion.history, from, FrequencyWatch::Effort::bounded);
  if (!found) return failed_newton({NewtonReport::End::inadmissible}, time);
  const double change = std::log(found->square / control.square);
  const bool changed = change > resolution || change < -0.5 * resolution;
  control.growth = changed ? change / control.since : 0.0;
  double square = found->square;
  const bool as_at_begin = square <= (1.0 + resolution) * control.first;
  if (square > square_of(1.0) && (control.parts == 1.0 || as_at_begin)) {
    if (std::optional<Failed> failed = decide(motion, time, square)) return failed;
  }
  set_interval(control, square);
  control.square = found->square;
  if (options_.clamp) divide(control, square <= square_of(1.0));
  control.limit = std::min(control.limit, 2.0 / std::sqrt(square));
  control.most_parts = std::max(control.most_parts, control.parts);
  control.since = 0.0;
  control.stored = motion.stored;
  return std::nullopt;
}

/// A bound above the limit may be due to the bound: eigenvalues of the cells concerned decide.
std::optional<Failed> StableSteps::decide(const Motion& motion, double time, double& square) {
  const std::optional<FrequencyWatch::Bound> exact =
      watch_->bound(motion.q, motion.history, square_of(1.0), FrequencyWatch::Effort::exact);
  if (!exact) return failed_newton({NewtonReport::End::inadmissible}, time);
  if (exact->square <= square_of(1.0)) {
    square = square_of(1.0);
    return std::nullopt;
  }
  if (options_.clamp) return std::nullopt;
  return Failed{
      Failed::Cause::step_too_small, time,
      fmt::format("the stable limit has fallen to {:.6g} s, below the step of {:.6g} s, by {}: "
                  "take a smaller step, above_limit: clamp, or an implicit integrator",
                  2.0 / std::sqrt(exact->square), options_.step, watch_->place(*exact))};
}

/// From a short one at the begin, twice as long each time, but the shortest affordable one while
/// the bound changes; where a refusal is near, until it may be there.
void StableSteps::set_interval(Control& control, double square) const {
  const double least = watch_->least_interval();
  control.interval = control.growth != 0.0 && control.interval >= least
                         ? least
                         : std::min(2.0 * control.interval, longest);
  if (options_.clamp && control.growth > 0.0) {
    const double steps = std::log(most_foreseen) / (foresight * control.growth);
    control.interval = std::clamp(steps, shortest, control.interval);
  }
  if (options_.clamp || control.growth <= 0.0 || square >= square_of(1.0)) return;
  const double steps = std::log(square_of(1.0) / square) / control.growth;
  control.interval = std::clamp(steps, shortest, control.interval);
}

/// Parts that are stable up to the next bound. A whole step, which was stable at the begin, is so
/// while the bound is no higher than then.
void StableSteps::divide(Control& control, bool whole_is_stable) const {
  const double growth = std::max(0.0, control.growth);
  const double foreseen = std::exp(foresight * growth * control.interval);
  const double expected = control.square * std::min(most_foreseen, foreseen);
  const double needed = options_.step * std::sqrt(expected) / (2.0 * part_of_limit);
  if (whole_is_stable && expected <= (1.0 + resolution) * control.first)
    control.parts = 1.0;
  else if (expected > near * square_of(control.parts) || needed <= control.parts - 1.0)
    control.parts = std::ceil(needed);
}

std::vector<std::string> StableSteps::measure_names() {
  return {"stable_step.min", "stable_step.parts"};
}

std::vector<double> StableSteps::measure(const Motion& motion) const {
  if (motion.control.empty()) return {options_.limit, 1.0};
  std::vector<double> list = motion.control;
  const Control control(list);
  return {control.limit, control.most_parts};
}

}  // namespace abut
