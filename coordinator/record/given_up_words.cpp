#include "coordinator/record/given_up_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace abut {

namespace {

/// Of the largest energy: less is what numbers are worth.
constexpr double nothing = 1.0e-6;

/// Of what was given up: a cause of less is not told.
constexpr double little = 1.0e-3;

/// Of the forces that a step began with: bodies that leave more of them are not at rest.
constexpr double trusted = 0.1;

/// Where most of it is; -1: nowhere.
int most_of(const std::vector<double>& values) {
  const auto most = std::ranges::max_element(values);
  return most == values.end() || !(*most > 0.0) ? -1 : static_cast<int>(most - values.begin());
}

std::string share(std::int64_t part, std::int64_t all) {
  return fmt::format("{:.3g} %", 100.0 * static_cast<double>(part) /
                                     static_cast<double>(std::max<std::int64_t>(all, 1)));
}

std::string windows_words(const GivenUp& up, std::int64_t windows) {
  std::string text = share(up.windows, windows) + " of the windows were solved passively";
  const bool rests = up.unbalanced < trusted;
  if (up.statics)
    text += rests ? ", without inertia, by forces on nodes that are right to some hundredths where "
                    "faces press, and less where edges press on few cells"
                  : ", without inertia, by forces on nodes that cannot be relied on";
  if (up.halved_windows > 0)
    text += fmt::format(", {} in shorter steps", share(up.halved_windows, windows));
  if (up.rigid_windows > 0)
    text += fmt::format(", and bodies were held rigid for an instant in {}",
                        share(up.rigid_windows, windows));
  if (up.unsettled > 0)
    text += fmt::format(
        ", and after {} of their steps bodies did not rest yet: forces that were not in balance "
        "are up to {:.2g} % of the most that a step began with",
        up.unsettled, 100.0 * up.unbalanced);
  return text;
}

std::string joules_words(const GivenUp& up) {
  std::string text =
      fmt::format("{:.3g} J of {:.3g} J were given up in them", up.joules(), up.largest);
  std::string causes;
  const auto add = [&](double joules, const char* cause) {
    if (std::abs(joules) > little * std::abs(up.joules()))
      causes += fmt::format("{}{:.3g} J {}", causes.empty() ? "" : ", ", joules, cause);
  };
  add(up.impacts, "by restitution where rigid bodies struck each other");
  add(up.normal - up.impacts - up.push_out, "in normal contact");
  add(up.damped, "by damping");
  add(up.switched, "where bodies changed their form");
  if (!causes.empty()) text += " (" + causes + ")";
  if (up.owed > little * std::abs(up.joules()))
    text += fmt::format(", of which {:.3g} J are given back as bodies part that touch at the end",
                        up.owed);
  if (up.friction != 0.0) text += fmt::format(", and friction took {:.3g} J", up.friction);
  return text;
}

}  // namespace

std::optional<GivenUpRemedy> remedy_of(const GivenUp& up) {
  if (up.statics) return {};
  // What rigid bodies lose to each other is restitution: no mesh and no step changes it. What is
  // owed is not lost.
  const bool lost_much = up.joules() - up.impacts - up.owed > nothing * up.largest;
  if (!lost_much && up.rigid_windows == 0) return {};
  // Normal contact loses the motion of the nodes that meet, and so do changes of form: their mass
  // falls with the mesh. What bodies lose that are held rigid falls with the steps.
  const double normal = up.normal - up.impacts - up.push_out, by_mesh = normal + up.switched;
  if (by_mesh < up.damped) {
    const int body = most_of(up.refused_by.empty() ? up.taken : up.refused_by);
    if (body >= 0) return GivenUpRemedy{body, false};
  }
  const int body = most_of(normal >= up.switched ? up.lost : up.taken);
  if (body < 0) return {};
  return GivenUpRemedy{body, true};
}

std::string given_up_words(const GivenUp& up, std::int64_t windows,
                           std::span<const Description* const> bodies) {
  const bool repaid = up.repaid > nothing * up.largest;
  if (up.windows == 0 && up.near_windows == 0 && !repaid) return {};
  std::string text;
  if (up.windows > 0) text = windows_words(up, windows);
  if (up.windows > 0)
    text += "; " + (up.statics ? "work that is told of them is of bodies on their way to rest, so "
                                 "the account of energy stays open"
                               : joules_words(up));
  if (up.near_windows > 0)
    text += fmt::format("{}{} of the windows have nearly converged, with residuals up to {:.2g}",
                        text.empty() ? "" : "; ", share(up.near_windows, windows), up.missed);
  if (repaid)
    text += fmt::format(
        "{}{:.3g} J of {:.3g} J that accurate windows had gained were taken back from the swinging "
        "of bodies",
        text.empty() ? "" : "; ", up.repaid, up.largest);
  if (up.statics && up.windows > 0)
    text += "; smaller windows and steps would leave more of them to the accurate method";
  if (up.deepest > 0.0)
    text += fmt::format("; surfaces were up to {:.3g} m behind each other", up.deepest);
  if (const std::optional<GivenUpRemedy> remedy = remedy_of(up)) {
    const std::string& name = bodies[static_cast<std::size_t>(remedy->body)]->name;
    text += remedy->finer_mesh ? fmt::format(
                                     "; a finer mesh of '{}' where it meets others would "
                                     "lose less",
                                     name)
                               : fmt::format("; smaller steps of '{}' would lose less", name);
  }
  return text;
}

}  // namespace abut
