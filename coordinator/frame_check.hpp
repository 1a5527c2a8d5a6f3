#pragma once

#include <cstddef>
#include <span>

#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Nodes and cells of what a body tells fields of; none where the scene writes none.
struct FieldSize {
  std::size_t nodes = 0, cells = 0;
};

/// What a body in another process cannot send, because no frame of `limit` bytes holds it, is
/// refused before the run: the description, the reply to a window that is iterated, fields.
/// `bodies` are in the scene's order, null where not known; `fields` in the same order, or empty.
void check_frames(const Scene& scene, std::span<const Description* const> bodies,
                  std::span<const FieldSize> fields, std::size_t limit, const Document& document);

}  // namespace abut
