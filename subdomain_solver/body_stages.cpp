// How a body goes on from a checkpoint, of itself or of what it was in the stage before.

#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "contract/hand_over.hpp"
#include "subdomain_solver/body.hpp"

namespace abut {

/// What another model or mesh of the body has handed over. Throws RunError.
void Body::take_from(Archive& archive) {
  HandOver handed;
  handed.state(archive);
  archive.finish();
  const Description& own = describe();
  const std::string of = fmt::format("body '{}'", own.name);
  if (interior_->able().successor == nullptr)
    throw RunError("is of a kind that takes over from no other", of,
                   "Give it fe, modal or rigid in all stages, and as fe in one dimension another "
                   "law than linear_elastic");
  if (handed.columns != own.columns)
    throw RunError("tells of other supports than the stage before", of,
                   "Give the body supports of the same names in all stages");
  interior_->able().successor->take_from(handed);
}

/// Throws RunError.
void Body::read_checkpoint(std::span<const std::byte> bytes) {
  Archive archive = Archive::reader(bytes, Archive::Form::named);
  std::string scheme, basis;
  bool statics = false;
  archive.field("scheme", scheme);
  if (scheme == handed_over) return take_from(archive);
  archive.field("statics", statics);
  archive.field("basis", basis);
  const std::string& own = interior_->traits().scheme;
  Successor* const successor = interior_->able().successor;
  if (scheme != own && successor == nullptr)
    throw RunError(fmt::format("cannot go on by {} where {} has left it", own, scheme),
                   fmt::format("body '{}'", describe().name),
                   "Give its integrator the same name in all stages");
  if (basis != interior_->traits().basis)
    throw RunError(fmt::format("goes on with modes of {} mass, and its state is of {} mass",
                               interior_->traits().basis, basis),
                   fmt::format("body '{}'", describe().name),
                   "Give its integrator the same mass in all stages, as mass: lumped");
  const auto by = statics ? Successor::Before::statics : Successor::Before::motion;
  if (successor == nullptr)
    interior_->state(archive);
  else
    successor->take_over(archive, scheme == own ? Successor::Before::own : by);
  archive.finish();
}

}  // namespace abut
