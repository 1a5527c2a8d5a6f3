#pragma once

namespace abut {

/// Of a cell of the coarser mesh: curved boundaries of unlike meshes are this far apart where they
/// are one, and no more.
constexpr double unlike_meshes_gap = 0.25;

}  // namespace abut
