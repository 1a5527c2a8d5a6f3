#include "subdomain_solver/make/statics.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/hourglass.hpp"
#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/make/fields.hpp"
#include "subdomain_solver/make/stabilisation_spec.hpp"

namespace abut {

namespace {

/// The first cell of one of the pieces of a mesh.
std::string cell_of_piece(const Mesh& mesh, int piece) {
  const std::int32_t first = connected_pieces(mesh)[piece].front();
  for (std::size_t block = 0; block < mesh.blocks.size(); ++block) {
    const CellBlock& cells = mesh.blocks[block];
    const auto found = std::find(cells.nodes.begin(), cells.nodes.end(), first);
    if (found == cells.nodes.end()) continue;
    return cell_text(mesh, block, index(found - cells.nodes.begin()) / index(cells.element->nodes));
  }
  return fmt::format("node {}", first + 1);
}

/// Statics has nothing but stiffness to hold a cell by.
void check_hourglasses(const FeModel& model, const Place& place) {
  const FeOptions& options = model.options();
  if (options.formulation != Formulation::one_point || options.hourglass > 0.0) return;
  for (const CellBlock& cells : model.mesh().blocks) {
    if (!has_hourglasses(*cells.element)) continue;
    throw InputError(fmt::format("has no answer: hourglass is 0, and nothing else holds {} of one "
                                 "point against hourglasses",
                                 cells.element->name),
                     place.where("integrator.quasi_static"),
                     "Leave hourglass out, or use formulation: full or mean_dilatation.");
  }
}

/// [N/m] of the body in tension along its largest extent.
double stiffness_of(const FeModel& model) {
  const Mesh& mesh = model.mesh();
  const Eigen::Map<const Eigen::MatrixXd> points(mesh.points.data(), mesh.dim, mesh.node_count());
  const double length = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  return model.material().moduli().youngs() * model.volume() / (length * length);
}

constexpr auto stabilisation_of = [](const auto& scheme) -> std::optional<StabilisationSpec> {
  if constexpr (requires { scheme.stabilisation; }) return scheme.stabilisation;
  return std::nullopt;
};

/// Columns of length sqrt(n) have components of sqrt(dim) where the body is carried along an axis:
/// by `dim` such a motion meets the stiffness that the scene gives.
LooseMotions stabilised(const FeModel& model, const std::vector<int>& held,
                        const StabilisationSpec& spec) {
  const double dim = model.mesh().dim;
  return {loose_motions(model, held), dim * spec.stiffness * stiffness_of(model), spec.at_most};
}

}  // namespace

LooseMotions check_statics(const BodySpec& spec, const Place& place, const FeModel& model,
                           const std::vector<Prescribed>& supports, OtherHold other) {
  if (!spec.integrates(SchemeKind::statics)) return {};
  const std::optional<StabilisationSpec> asked = std::visit(stabilisation_of, *spec.integrator);
  std::vector<int> held;
  for (const Prescribed& p : supports) held.push_back(p.dof);
  const std::optional<LoosePiece> loose = find_loose_piece(model, held);
  check_hourglasses(model, place);
  const bool whole = loose && loose->pieces == 1;
  if (whole && !other.joined && other.touched)
    return stabilised(model, held, asked.value_or(StabilisationSpec{}));
  if (asked && (!loose || other.joined)) {
    throw InputError("has no effect: the body is held by its constraints, or carried by its ties",
                     place.where("integrator.quasi_static.stabilisation"), "Leave it out.");
  }
  if (!loose) return {};
  if (whole && other.joined) return {loose_motions(model, held)};
  const std::string motions =
      fmt::format("{} rigid motion{}", loose->motions, loose->motions == 1 ? "" : "s");
  if (loose->pieces == 1) {
    throw InputError(
        fmt::format("has no answer: the constraints leave the body free to move or turn as a whole "
                    "({})",
                    motions),
        place.where("integrator.quasi_static"),
        "Hold it by constraints, of points where sides do not suffice, tie it to others that are "
        "held, let contact hold it, or use newmark.");
  }
  throw InputError(
      fmt::format("has no answer: the mesh is of {} pieces that share no node, and the constraints "
                  "leave that with {} free to move or turn ({})",
                  loose->pieces, cell_of_piece(model.mesh(), loose->piece), motions),
      place.where("integrator.quasi_static"),
      "Join the pieces in the mesh, hold every one of them, or make bodies of them.");
}

}  // namespace abut
