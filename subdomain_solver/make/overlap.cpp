#include "subdomain_solver/make/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/index.hpp"
#include "base/yaml_resolved.hpp"
#include "subdomain_solver/fe/facet_index.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/read_body.hpp"
#include "subdomain_solver/overlap/cell_shares.hpp"
#include "subdomain_solver/overlap/conforming.hpp"
#include "subdomain_solver/overlap/embed.hpp"
#include "surface/unlike_meshes.hpp"

namespace abut {

namespace {

/// Of a body, what is to be the same in both.
struct Scheme {
  std::optional<BodySpec::Integrator> integrator;
  void fields(Fields& f) { f.choice("integrator", integrator, "in time"); }
};
struct Law {
  std::optional<MaterialSpec> material;
  void fields(Fields& f) { f.choice("material", material, "of the body"); }
};

struct OtherBody {
  BodySpec spec;
  Mesh mesh;
  std::string side;  // of its port
};

/// Nothing where it is no finite elements, or its own process tells what is wrong with it.
std::optional<OtherBody> read_other(const Place& own, const PortPartner& partner) {
  const std::optional<BodySpec> spec = read_partner(partner, own.document);
  const auto* fe = spec ? std::get_if<FeModelSpec>(&spec->model) : nullptr;
  if (fe == nullptr) return std::nullopt;
  const Place place{own.document, "bodies." + partner.body};
  require_same_file(*fe, place, "model.fe");
  try {
    OtherBody other{*spec, make_mesh(*fe, spec->initial.position, place, "model.fe"), {}};
    for (const auto& [name, port] : spec->ports)
      if (name == partner.port) other.side = port.side;
    if (!other.mesh.sides.contains(other.side)) return std::nullopt;
    return other;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

class Overlap {
 public:
  Overlap(const Place& place, const PortPartner& partner, const OtherBody& other,
          const std::string& side, Mesh& mesh)
      : place_(place),
        partner_(partner),
        role_(*partner.overlap),
        other_(other),
        side_(side),
        mesh_(mesh),
        own_(mesh),
        its_(other.mesh),
        skin_(mesh, FacetIndex(mesh).boundary()) {}

  void check(const BodySpec& spec) const;
  EmbeddedSurface find(const BodySpec& spec) const;

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const {
    throw InputError(
        what, place_.document.where("interfaces." + partner_.interface + ".tied.overlap"), remedy);
  }
  std::string at(const Eigen::Vector3d& x) const {
    return fmt::format("({:.6g}) m", fmt::join(x.data(), x.data() + mesh_.dim, ", "));
  }
  std::string its_side() const { return partner_.body + "." + partner_.port; }
  void share_cells(const CommonParts& common) const;
  void check_other_sides() const;
  void check_loads(const BodySpec& spec) const;
  void check_motions(const BodySpec& spec, const CommonParts& common) const;
  bool is_wide(double volume) const;
  void follow(EmbeddedSurface& inside) const;

  const Place& place_;
  const PortPartner& partner_;
  const OverlapRole& role_;
  const OtherBody& other_;
  const std::string& side_;
  Mesh& mesh_;
  MeshSimplices own_, its_;
  BoundarySimplices skin_;  // of this body
};

/// What the two of them can be.
void Overlap::check(const BodySpec& spec) const {
  const std::pair<const BodySpec*, std::string> both[] = {{&spec, place_.name()},
                                                          {&other_.spec, partner_.body}};
  for (const auto& [body, name] : both) {
    if (body->initial.adjust) {
      refuse(fmt::format("joins body '{}', which is adjusted: the other body does not see where "
                         "its nodes go",
                         name),
             "Take initial.adjust off it.");
    }
    if (body->shape()->plane == Plane::axisymmetric)
      refuse(fmt::format("joins body '{}' of rings", name),
             "Give bodies of the plane or of space.");
  }
  const SolidShapeSpec &own = *spec.shape(), &its = *other_.spec.shape();
  if (mesh_.dim == 2 && (own.plane != its.plane || own.thickness != its.thickness)) {
    refuse("joins bodies of unlike plane or thickness, which are not the same where both are",
           "Give both bodies the same plane and thickness.");
  }
  for (const Mesh* mesh : {&std::as_const(mesh_), &other_.mesh}) {
    for (const CellBlock& block : mesh->blocks) {
      if (block.element->order == 1) continue;
      refuse(fmt::format("joins a body of {}", block.element->name),
             "Give both bodies elements of first order.");
    }
  }
}

/// What goes with this body's side inside itself, and its cells' shares.
EmbeddedSurface Overlap::find(const BodySpec& spec) const {
  const CommonParts common = common_parts(own_, its_);
  if (common.parts.empty()) {
    const std::string names[] = {place_.name(), partner_.body};
    refuse(fmt::format("joins bodies '{}' and '{}', which do not take the same place anywhere",
                       names[role_.first ? 0 : 1], names[role_.first ? 1 : 0]),
           "Move a body with initial.position into the other, or leave overlap out where their "
           "sides meet.");
  }
  StickingOut out;
  EmbeddedSurface inside =
      embed(BoundarySimplices(other_.mesh, other_.mesh.side(other_.side)), own_, skin_, out);
  if (out.distance > unlike_meshes_gap * own_.spacing()) {
    refuse(fmt::format("side {} is not inside body '{}': it is {:.3g} m away from it at {}",
                       its_side(), place_.name(), out.distance, at(out.at)),
           "Move a body with initial.position, or give the port a side that lies wholly inside the "
           "other body.");
  }
  check_other_sides();
  if (role_.motions) {
    check_motions(spec, common);
    return inside;
  }
  if (is_wide(common.volume)) follow(inside);
  if (role_.halves) {
    share_cells(common);
    check_loads(spec);
  }
  return inside;
}

/// Each body keeps half of the material where both are.
void Overlap::share_cells(const CommonParts& common) const {
  for (CellBlock& block : mesh_.blocks)
    if (block.shares.empty()) block.shares.assign(block.nodes.size(), 1.0);
  for (const CommonParts::Part& part : common.parts) {
    CellBlock& block = mesh_.blocks[part.cell.block];
    if (is_shared(block, part.cell.cell)) {
      refuse(fmt::format("gives {} of body '{}' to a second partner",
                         cell_text(mesh_, index(part.cell.block), index(part.cell.cell)),
                         place_.name()),
             "Let no more than two bodies overlap in one place.");
    }
    for (std::size_t a = 0; a < part.of.size(); ++a)
      block.shares[index(part.cell.cell) * part.of.size() + a] = 1.0 - 0.5 * part.of[a];
  }
}

/// Bodies of half a material swing by themselves between sides that are farther apart than high.
bool Overlap::is_wide(double volume) const {
  double least = 0.0;
  for (const auto& [mesh, side] :
       {std::pair(&std::as_const(mesh_), side_), std::pair(&other_.mesh, other_.side)}) {
    const BoundarySimplices cut(*mesh, mesh->side(side));
    double area = 0.0;
    for (int i = 0; i < cut.count(); ++i) area += measure(cut.simplex(i));
    least = least == 0.0 ? area : std::min(least, area);
  }
  constexpr double more = 1.0 + 1.0e-6;
  return volume > more * least * std::pow(least, 1.0 / (mesh_.dim - 1.0));
}

/// Nodes of the coarser mesh follow the finer one between the sides: not on the coarser's own side,
/// and not in cells that the finer's side crosses, whose motion the rows of sides tell.
void Overlap::follow(EmbeddedSurface& inside) const {
  const bool coarser =
      own_.spacing() > its_.spacing() || (own_.spacing() == its_.spacing() && role_.first);
  const Mesh& coarse = coarser ? mesh_ : other_.mesh;
  std::vector<std::int32_t> told = coarse.nodes_of(coarser ? side_ : other_.side);
  StickingOut out;
  const EmbeddedSurface crossed =
      coarser ? inside
              : embed(BoundarySimplices(mesh_, mesh_.side(side_)), its_,
                      BoundarySimplices(other_.mesh, FacetIndex(other_.mesh).boundary()), out);
  told.insert(told.end(), crossed.rows.columns.begin(), crossed.rows.columns.end());
  std::ranges::sort(told);
  for (const HeldNode& held : held_nodes(coarse, coarser ? its_ : own_)) {
    if (std::ranges::binary_search(told, held.node)) continue;
    if (coarser) {
      add_node(mesh_, held.node, inside);
      continue;
    }
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int i = 0; i < mesh_.dim; ++i) place(i) = coarse.points[held.node * mesh_.dim + i];
    add_point(mesh_, place, held.cell, inside);
  }
}

/// A free boundary inside the body would be a crack in half of its material.
void Overlap::check_other_sides() const {
  const std::vector<Facet>& side = other_.mesh.side(other_.side);
  std::vector<Facet> others;
  for (const Facet& facet : FacetIndex(other_.mesh).boundary())
    if (std::ranges::find(side, facet) == side.end()) others.push_back(facet);
  const BoundarySimplices its(other_.mesh, others);
  std::vector<FacetPair> pairs;
  overlapping_pairs(its.tree, own_.tree(), pairs);
  for (const FacetPair& pair : pairs) {
    const Simplex facet = its.simplex(pair.k);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int i = 0; i < facet.count; ++i) middle += facet.x[i] / facet.count;
    const std::vector<HalfSpace> cell = sides_of(own_.simplex(pair.n));
    const auto outside = [&](const HalfSpace& half) { return half.distance(middle) > 0.0; };
    if (std::ranges::any_of(cell, outside)) continue;
    const double depth = distance(skin_, middle);
    if (depth <= unlike_meshes_gap * own_.spacing()) continue;
    refuse(fmt::format("body '{}' ends inside body '{}' at {}, {:.3g} m deep, but not with side {}",
                       partner_.body, place_.name(), at(middle), depth, its_side()),
           "Give the port the whole boundary that lies inside the other body.");
  }
}

/// With inertia, motions that are told in turn gain energy, but where both bodies are the same.
void Overlap::check_motions(const BodySpec& spec, const CommonParts& common) const {
  const auto rests = [](const BodySpec& body) { return body.integrates(SchemeKind::statics); };
  if (role_.unstable || (rests(spec) && rests(other_.spec))) return;
  constexpr const char* why =
      "the pair would gain energy by itself, up to some thousand times a second";
  const std::string otherwise =
      "Leave exchange out, which keeps energy between any meshes and schemes; or see it happen "
      "with "
      "unstable: true.";
  const auto unlike = [](const auto& one, const auto& other) {
    return to_yaml(one) != to_yaml(other);
  };
  if (unlike(Scheme{spec.integrator}, Scheme{other_.spec.integrator})) {
    refuse(fmt::format("exchanges motions alone between bodies of unlike integrators: {}", why),
           otherwise);
  }
  if (unlike(Law{spec.material}, Law{other_.spec.material})) {
    refuse(fmt::format("exchanges motions alone between bodies of unlike materials: {}", why),
           otherwise);
  }
  if (!role_.first) return;  // the other body has told: where all its cells have twins, all have
  const std::optional<CellPlace> lone = first_without_twin(common, mesh_, other_.mesh);
  if (!lone) return;
  refuse(
      fmt::format("exchanges motions alone where nodes do not meet ({} of body '{}' is no cell of "
                  "body '{}'): {}",
                  cell_text(mesh_, index(lone->block), index(lone->cell)), place_.name(),
                  partner_.body, why),
      otherwise);
}

/// Tractions would be there twice.
void Overlap::check_loads(const BodySpec& spec) const {
  for (const auto& [name, load] : spec.loads) {
    if (load.on.empty() || !mesh_.sides.contains(load.on)) continue;
    for (const Facet& facet : mesh_.side(load.on)) {
      if (!is_shared(mesh_.blocks[facet.block], facet.cell)) continue;
      throw InputError(fmt::format("side '{}' reaches into the overlap {}, where body '{}' would "
                                   "carry the load as well",
                                   load.on, partner_.interface, partner_.body),
                       place_.where("loads." + name), "Load sides that end before the overlap.");
    }
  }
}

}  // namespace

void overlap_partners(const BodySpec& spec, const Place& place, Mesh& mesh,
                      std::vector<SolidInterior::PortNodes>& ports) {
  for (SolidInterior::PortNodes& port : ports) {
    const PortRole role = spec.context.role(port.name);
    const auto partner = std::ranges::find_if(
        role.partners, [](const PortPartner& other) { return other.overlap.has_value(); });
    if (partner == role.partners.end() || !mesh.sides.contains(port.side)) continue;
    const std::optional<OtherBody> other = read_other(place, *partner);
    if (!other || other->mesh.dim != mesh.dim) continue;
    const Overlap overlap(place, *partner, *other, port.side, mesh);
    overlap.check(spec);
    port.inside = overlap.find(spec);
  }
}

}  // namespace abut
