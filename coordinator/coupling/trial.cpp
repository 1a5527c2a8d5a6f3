#include "coordinator/coupling/trial.hpp"

#include <algorithm>
#include <cmath>

#include "coordinator/coupling/exchange_parts.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {
/// Windows cut short by events have lengths of their own.
constexpr std::size_t kept_answers = 16;
}  // namespace

void Trial::ask(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  const double next = bodies.window() > 0.0 ? bodies.window() : window.length();
  for (const Side& side : joint.sides) bodies.request(side.body).ahead = next;
}

bool Trial::see(const TimeWindow& window, const std::array<Substeps, 2>& grids, const Joint& joint,
                Bodies& bodies) {
  std::array<const Waveform*, 2> looks;
  for (std::size_t s : {0u, 1u}) looks[s] = look_of(bodies, joint.sides[s], grids[s]);
  if (looks[0] == nullptr || looks[1] == nullptr) return false;
  for (int s : {0, 1}) {
    Waveform& motion = motions_[s];
    motion = *looks[s];
    if (joint.contact.impulse == 0.0) continue;
    const std::vector<double>& moved = answer(s, window, joint, bodies);
    if (moved.size() + 1 != motion.size()) return false;
    for (std::size_t i = 0; i < moved.size(); ++i)
      motion.u[i + 1] += joint.normal_of(s) * joint.contact.impulse * moved[i];
  }
  return true;
}

const std::vector<double>& Trial::answer(int side, const TimeWindow& window, const Joint& joint,
                                         Bodies& bodies) {
  const double length = window.length();
  const auto same = [&](const Struck& known) {  // ends of equal windows are rounded differently
    return known.side == side && std::abs(known.length - length) <= 1.0e-9 * length;
  };
  const auto known = std::ranges::find_if(answers_, same);
  if (known != answers_.end()) return known->moved;
  if (answers_.size() >= kept_answers) answers_.pop_front();
  answers_.push_back({length, side, bodies.impulse_response(joint.sides[side], window)});
  return answers_.back().moved;
}

void Trial::state(Archive& archive) {
  list(archive, "answers", answers_, [](Archive& a, Struck& struck) {
    a.field("length", struck.length);
    whole(a, "side", struck.side);
    a.field("moved", struck.moved);
  });
}

}  // namespace abut
