#pragma once

#include <cstdint>

#include "tests/random/random_scene.hpp"

namespace abut {

/// A row of bars in one dimension that fly at each other, some of them tied, some rows between
/// walls.
RandomScene random_bars(Draw& draw, std::uint64_t seed, double speed);

/// Some bodies become boxes that cut_wholes() divides.
void choose_what_is_cut(Draw& draw, RandomScene& scene);
/// Some bodies spin, some tools turn, some floors move.
void choose_turns(Draw& draw, RandomScene& scene);
/// Boxes become parts of unlike meshes, laws and steps that are tied to each other.
void cut_wholes(Draw& draw, RandomScene& scene);

}  // namespace abut
