#include "subdomain_solver/make/adjust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/read_body.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/port_geometry.hpp"
#include "surface/check.hpp"
#include "surface/least_opening.hpp"
#include "surface/start_rows.hpp"

namespace abut {

namespace {

/// Of a facet: what nodes are moved beyond the partner's surface, so that roundings press nothing.
constexpr double margin = 1.0e-10;

/// Normals and feet of nodes follow the nodes: so often they are found anew.
constexpr int most_passes = 50;
constexpr int most_sweeps = 2000;

constexpr const char* adjust_key = "initial.adjust";

/// A shape alone, as ports show it: nothing asks for stiffness or mass.
PortGeometry surface_of(const SolidShapeSpec& shape, const Mesh& mesh, const std::string& side) {
  FeOptions options;
  options.plane = shape.plane;
  options.thickness = shape.thickness;
  const FeModel model(mesh, std::make_unique<LinearElastic>(Moduli{1.0, 1.0}, 1.0), options);
  return port_geometry(model, side, mesh.nodes_of(side));
}

PosedSurface posed(const PortGeometry& surface) {
  return {surface.dim, surface.points, surface.facets, surface.offsets};
}

bool is_sound(const PortGeometry& surface) {
  return !surface.facets.empty() && !check(posed(surface));
}

/// A contact of the body that is adjusted.
struct PortMeeting {
  std::string interface;
  bool own_rows = true;             // contact will have rows of the body's nodes
  bool points = false;              // ... of single ones
  std::vector<std::int32_t> nodes;  // of the body's mesh, by point
  PortGeometry own, partner;
  std::vector<char> closes;  // (points) their gap is to be closed

  /// As contact will have them, of the nodes of one of its sides.
  SurfaceRows rows(const StartSurface& k, const StartSurface& n) const {
    return points ? node_rows(k, n) : average_rows(k, n);
  }
  StartSurface one() const { return {posed(own), own.spacing}; }
  StartSurface other() const { return {posed(partner), partner.spacing}; }
};

/// Rows over the coordinates of the body's mesh.
struct AdjustRows {
  SparseRows rows;
  std::vector<double> gaps;  // [m]
  std::vector<char> met;     // gaps are to be closed
  double overlap = 0.0;      // [m] the deepest
  double left = 0.0;         // [m] the largest gap that is to be closed
  std::string interface;     // of the deepest
};

/// Bodies of finite elements find contact on their surfaces, but for rings.
bool finds(const BodySpec& body) {
  return std::holds_alternative<FeModelSpec>(body.model) &&
         body.shape()->plane != Plane::axisymmetric;
}

class Adjuster {
 public:
  Adjuster(const BodySpec& spec, const Place& place, const Constraints& constraints, Mesh& mesh)
      : spec_(spec), place_(place), mesh_(mesh), begin_(mesh.points) {
    for (const Prescribed& p : constraints.supports) hold(p.dof, constraints.frames);
  }

  void meet(const std::string& port, const std::string& side);
  std::string run();

 private:
  void hold(int dof, const std::vector<NodeFrame>& frames);
  std::optional<Mesh> partner_mesh(const PortPartner& contact, const BodySpec& partner) const;
  void choose_gaps();
  double open_overlaps(bool closing);
  void add(const PortMeeting& m, const SurfaceRows& rows, bool as_partner, double allowed,
           AdjustRows& out) const;
  void add_rows(const PortMeeting& m, bool closing, AdjustRows& out) const;
  void pose();
  void check_cells() const;
  double moved(std::int32_t node) const;

  const BodySpec& spec_;
  const Place& place_;
  Mesh& mesh_;
  std::vector<double> begin_;             // [m] (nodes, dim) of the mesh as it was
  std::map<std::int32_t, Matrix3> free_;  // onto the directions in which a held node may go
  std::vector<PortMeeting> meetings_;
  AdjustRows rows_;  // of the last pass
};

void Adjuster::hold(int dof, const std::vector<NodeFrame>& frames) {
  const std::int32_t node = dof / mesh_.dim;
  Matrix3 axes = Matrix3::Identity();
  for (const NodeFrame& frame : frames)
    if (frame.node == node) axes = frame.axes;
  const Eigen::Vector3d along = axes.col(dof % mesh_.dim);
  Matrix3& way = free_.emplace(node, Matrix3::Identity()).first->second;
  way -= along * along.transpose();
}

/// The mesh of a partner of ours; nothing where its own process tells what is wrong with it.
std::optional<Mesh> Adjuster::partner_mesh(const PortPartner& contact,
                                           const BodySpec& partner) const {
  const Place place{place_.document, "bodies." + contact.body};
  const std::string model =
      std::visit([](const auto& kind) { return "model." + std::string(kind.name); }, partner.model);
  require_same_file(*partner.shape(), place, model);
  try {
    Mesh mesh = make_mesh(*partner.shape(), partner.initial.position, place, model);
    for (const auto& [name, port] : partner.ports)
      if (name == contact.port && mesh.sides.contains(port.side)) return mesh;
  } catch (const InputError&) {
  }
  return std::nullopt;
}

void Adjuster::meet(const std::string& port, const std::string& side) {
  const PortRole role = spec_.context.role(port);
  for (const PortPartner& contact : role.partners) {
    if (contact.tied) continue;
    if (contact.external)
      throw InputError(fmt::format("moves nodes onto the surface of {}, which only its own program "
                                   "knows",
                                   contact.body),
                       place_.where(adjust_key), "Move the body with initial.position instead.");
    const std::optional<BodySpec> partner = read_partner(contact, place_.document);
    if (!partner) continue;  // told of the partner itself
    if (partner->initial.adjust)
      throw InputError(fmt::format("is true of both sides of the interface {}", contact.interface),
                       place_.where(adjust_key), "Let one of them stay where it is.");
    if (partner->shape() == nullptr || partner->shape()->dimension != mesh_.dim) continue;
    const std::optional<Mesh> mesh = partner_mesh(contact, *partner);
    if (!mesh || !mesh_.sides.contains(side)) continue;
    PortMeeting m;
    m.interface = contact.interface;
    m.nodes = mesh_.nodes_of(side);
    m.closes.assign(m.nodes.size(), 0);
    m.own = surface_of(*spec_.shape(), mesh_, side);
    for (const auto& [its, port_spec] : partner->ports)
      if (its == contact.port) m.partner = surface_of(*partner->shape(), *mesh, port_spec.side);
    if (!is_sound(m.own) || !is_sound(m.partner)) continue;
    // The body that is adjusted finds the contact where it can and the scene does not fix it.
    m.points = contact.points;
    const bool finder = finds(spec_) && !contact.finds;
    const StartSurface own = m.one(), its = m.other();
    const bool turned = finder ? rows_of_other(own, its) : rows_of_other(its, own);
    m.own_rows = finder != (turned && !m.points);
    meetings_.push_back(std::move(m));
  }
}

/// The surfaces to where the mesh has gone.
void Adjuster::pose() {
  const std::size_t dim = index(mesh_.dim);
  for (PortMeeting& m : meetings_)
    for (std::size_t a = 0; a < m.nodes.size(); ++a)
      for (std::size_t i = 0; i < dim; ++i)
        m.own.points[a * dim + i] = mesh_.points[index(m.nodes[a]) * dim + i];
}

/// Rows in terms of the body's coordinates; `as_partner`: its surface is the one that they see.
void Adjuster::add(const PortMeeting& m, const SurfaceRows& rows, bool as_partner, double allowed,
                   AdjustRows& out) const {
  const SparseRows& own = as_partner ? rows.n : rows.k;
  for (int r = 0; r < rows.count(); ++r) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (int i = 0; i < mesh_.dim; ++i) normal(i) = rows.normals[r * mesh_.dim + i];
    if (as_partner) normal = -normal;
    for (std::int32_t e = own.offsets[r]; e < own.offsets[index(r) + 1]; ++e) {
      const std::int32_t node = m.nodes[own.columns[index(e)]];
      const auto held = free_.find(node);
      const Eigen::Vector3d way = held == free_.end() ? normal : held->second * normal;
      for (int i = 0; i < mesh_.dim; ++i) {
        out.rows.columns.push_back(node * mesh_.dim + i);
        out.rows.values.push_back(own.values[e] * way(i));
      }
    }
    out.rows.end_row();
    const double gap = rows.gaps[r] + allowed;
    if (-gap > out.overlap) out.interface = m.interface;
    out.overlap = std::max(out.overlap, -gap);
    out.gaps.push_back(gap);
    out.met.push_back(0);
  }
}

/// All rows in which the sides of a contact must not overlap; while gaps are closed, those of the
/// body's own nodes.
void Adjuster::add_rows(const PortMeeting& m, bool closing, AdjustRows& out) const {
  const StartSurface own = m.one(), partner = m.other();
  if (closing) {
    const std::size_t first = out.gaps.size();
    const SurfaceRows rows = m.rows(own, partner);
    add(m, rows, false, 0.0, out);
    for (std::size_t r = 0; r < rows.nodes.size(); ++r) {
      out.met[first + r] = m.closes[rows.nodes[r]];
      if (out.met[first + r] != 0) out.left = std::max(out.left, std::abs(rows.gaps[r]));
    }
    return;
  }
  const double allowed = roundness(own, partner);
  add(m, node_rows(own, partner), false, allowed, out);
  add(m, node_rows(partner, own), true, allowed, out);
  if (m.own_rows) {
    add(m, m.rows(own, partner), false, 0.0, out);
  } else {
    add(m, m.rows(partner, own), true, 0.0, out);
  }
}

/// Which nodes are before a partner and no farther from it than adjust_gaps.
void Adjuster::choose_gaps() {
  for (PortMeeting& m : meetings_) {
    if (spec_.initial.adjust_gaps > m.own.spacing)
      throw InputError(fmt::format("is {:g} m, more than the facets of the body at the interface "
                                   "{}, {:.3g} m",
                                   spec_.initial.adjust_gaps, m.interface, m.own.spacing),
                       place_.where("initial.adjust_gaps"),
                       "Move the body with initial.position, and give what is left.");
    const SurfaceRows rows = m.rows(m.one(), m.other());
    for (std::size_t r = 0; r < rows.nodes.size(); ++r)
      m.closes[rows.nodes[r]] = rows.gaps[r] > 0.0 && rows.gaps[r] <= spec_.initial.adjust_gaps;
  }
}

/// One pass: moves nodes by the least that opens all rows as they are now, or closes them. [m] what
/// was to be moved; 0: nothing.
double Adjuster::open_overlaps(bool closing) {
  rows_ = {};
  rows_.rows.clear();
  double smallest = std::numeric_limits<double>::infinity(), extent = 0.0;
  for (const PortMeeting& m : meetings_) {
    add_rows(m, closing, rows_);
    smallest = std::min(smallest, facet_size(m.one(), m.other()));
  }
  for (double x : mesh_.points) extent = std::max(extent, std::abs(x));
  const double beyond = margin * smallest + 16.0 * std::numeric_limits<double>::epsilon() * extent;
  const double left = rows_.left > 2.0 * beyond ? rows_.left : 0.0;
  const double wrong = std::max(rows_.overlap, left);
  if (wrong == 0.0) return 0.0;
  for (double& gap : rows_.gaps) gap -= beyond;
  std::vector<double> way(mesh_.points.size(), 0.0);
  least_opening(rows_.rows, rows_.gaps, rows_.met, 0.1 * beyond, most_sweeps, way);
  for (std::size_t k = 0; k < way.size(); ++k) mesh_.points[k] += way[k];
  return wrong;
}

double Adjuster::moved(std::int32_t node) const {
  double way = 0.0;
  for (int i = 0; i < mesh_.dim; ++i) {
    const std::size_t k = index(node * mesh_.dim + i);
    way = std::hypot(way, mesh_.points[k] - begin_[k]);
  }
  return way;
}

/// Cells behind the surface keep their other nodes.
void Adjuster::check_cells() const {
  try {
    check_mesh(mesh_, "");
  } catch (const InputError& error) {
    double most = 0.0;
    for (std::int32_t node = 0; node < mesh_.node_count(); ++node)
      most = std::max(most, moved(node));
    throw InputError(fmt::format("moves nodes by up to {:.3g} m, and then the mesh {}", most,
                                 error.what_is_wrong),
                     place_.where(adjust_key),
                     "Move the body with initial.position until less is left to adjust, or make "
                     "its cells larger.");
  }
}

std::string Adjuster::run() {
  if (spec_.initial.adjust_gaps > 0.0) choose_gaps();
  for (const bool closing : {true, false}) {
    if (closing && spec_.initial.adjust_gaps == 0.0) continue;
    for (int pass = 0; pass < most_passes && open_overlaps(closing) > 0.0; ++pass) pose();
  }
  if (rows_.overlap > 0.0) {
    throw InputError(fmt::format("leaves an overlap of {:.3g} m at the interface {}", rows_.overlap,
                                 rows_.interface),
                     place_.where(adjust_key),
                     "Move a body with initial.position until they are apart, and do not hold "
                     "nodes that overlap.");
  }
  check_cells();
  int count = 0;
  double most = 0.0;
  for (std::int32_t node = 0; node < mesh_.node_count(); ++node) {
    const double way = moved(node);
    count += way > 0.0 ? 1 : 0;
    most = std::max(most, way);
  }
  return fmt::format(" with {} nodes moved by up to {:.3g} m", count, most);
}

}  // namespace

std::string adjust_ports(const BodySpec& spec, const Place& place,
                         const std::vector<SolidInterior::PortNodes>& ports,
                         const Constraints& constraints, Mesh& mesh) {
  if (!spec.initial.adjust) return "";
  Adjuster adjuster(spec, place, constraints, mesh);
  bool touched = false;
  for (const SolidInterior::PortNodes& port : ports) {
    touched = touched || port.touched;
    adjuster.meet(port.name, port.side);
  }
  if (!touched)
    throw InputError("has no effect: no interface lets the body touch another one",
                     place.where(adjust_key),
                     "Leave it out, or declare the contact under interfaces.");
  return adjuster.run();
}

}  // namespace abut
