#include "coordinator/hand_over.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

bool is_stress(std::string_view name) { return name == "stress" || name == "von_mises"; }

}  // namespace

HandOver hand_over(Subdomain& body, const BodyRecord& record) {
  const Description& about = body.describe();
  const std::string of = fmt::format("body '{}'", about.name);
  if (about.quasi_static)
    throw RunError("stands in statics, and another model or mesh of it would not be in balance", of,
                   "Let it move in one stage, and change its model in the next");
  HandOver handed;
  handed.model = about.model;
  handed.mass = about.mass;
  handed.record = record;
  handed.columns = about.columns;
  std::vector<FieldValues> fields = body.fields();
  for (std::size_t k = 0; k < std::min(fields.size(), about.fields.size()); ++k) {
    const FieldInfo& field = about.fields[k];
    if (field.name == "displacement") handed.displacement = std::move(fields[k]);
    if (field.name == "velocity") handed.velocity = std::move(fields[k]);
    if (field.place != FieldPlace::cells) continue;
    handed.deforms = true;
    if (is_stress(field.name)) continue;
    if (std::ranges::all_of(fields[k], [](double value) { return value == 0.0; })) continue;
    throw RunError(fmt::format("has a history, {}, which another model or mesh of it cannot take "
                               "over",
                               field.name),
                   of, "Change its model before it yields, or keep it");
  }
  handed.grid = body.grid();
  const std::size_t values = 3 * handed.grid.nodes();
  if (values == 0 || handed.displacement.size() != values || handed.velocity.size() != values)
    throw RunError("does not tell the displacement and velocity of its nodes", of,
                   "Keep its model in all stages");
  return handed;
}

}  // namespace abut
