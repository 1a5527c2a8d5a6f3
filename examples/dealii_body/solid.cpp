// A linear solid as a body of abut; mesh, elements and matrices are deal.II's (libdeal.ii-dev).
// usage: solid --connect ENDPOINT --body NAME      (README.md beside this file)
#include <abut.hpp>

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>

using abut::Values;

namespace {

std::size_t at(int place) { return static_cast<std::size_t>(place); }

/// y = K x on plain numbers, in which a body's state is kept.
void multiply(const dealii::SparseMatrix<double>& k, const Values& x, Values& y) {
  dealii::Vector<double> from(x.begin(), x.end()), to(k.m());
  k.vmult(to, from);
  y.assign(to.begin(), to.end());
}

}  // namespace

/// A box, one side of which is the port, or a ball with all of its skin: FE_Q of degree 1 or 2,
/// masses lumped by Gauss-Lobatto points, central difference.
template <int space>
class Solid : public abut::Body {
 public:
  explicit Solid(const abut::Keys& keys)
      : degree_(static_cast<int>(keys.get("degree", 1))),
        fe_(dealii::FE_Q<space>(order(keys)), space) {
    dim = space;
    model = std::string(space == 2 ? "plane" : "solid") + " of deal.II " DEAL_II_PACKAGE_VERSION +
            ", degree " + std::to_string(degree_) + ", central difference";
    substep = keys.positive("step", "s");
    make_mesh(keys);
    dofs_.reinit(mesh_);
    dofs_.distribute_dofs(fe_);
    number_nodes();
    find_port(keys);
    make_matrices(keys);
    const Values velocity = keys.numbers("velocity", space, "m/s");
    u_.assign(dofs_.n_dofs(), 0.0);
    v_ = pull_ = u_;
    for (const auto& node : nodes_)
      for (std::size_t c = 0; c < space; ++c) v_[node[c]] = velocity[c];
    state = {{"u all", u_}, {"v all", v_}, {"pull", pull_}};
    conserves = linear = true;
  }

  std::vector<abut::Surface> surface() override {
    abut::Surface face{{}, facets_};
    for (const int node : port_)
      for (std::size_t c = 0; c < space; ++c) face.points.push_back(places_[at(node) * space + c]);
    face.transit = transit_;
    return {face};
  }

  void step(double dt, const Values& force) override {
    kick(dt / 2, force);
    for (std::size_t k = 0; k < u_.size(); ++k) u_[k] += dt * v_[k];
    multiply(stiffness_, u_, pull_);
    kick(dt / 2, force);
  }

  Values displacement() override { return of_port(u_); }
  Values velocity() override { return of_port(v_); }

  /// What central differences conserve: velocities before and after a level, multiplied.
  abut::Energy energy() override {
    abut::Energy energy{};
    for (std::size_t k = 0; k < u_.size(); ++k) {
      const double change = substep / 2 * pull_[k] / masses_[k];
      energy.kinetic += 0.5 * masses_[k] * (v_[k] * v_[k] - change * change);
      energy.stored += 0.5 * u_[k] * pull_[k];
    }
    return energy;
  }
  Values momentum() override {
    Values all(space, 0.0);
    for (const auto& node : nodes_)
      for (std::size_t c = 0; c < space; ++c) all[c] += masses_[node[c]] * v_[node[c]];
    return all;
  }

  abut::Grid grid() override { return {places_, cells_}; }
  abut::Fields node_fields() override {
    return {{"displacement", in_space(u_)}, {"velocity", in_space(v_)}};
  }
  /// [Pa] in the middle of cells.
  abut::Fields cell_fields() override {
    const dealii::Vector<double> motion(u_.begin(), u_.end());
    std::vector<dealii::SymmetricTensor<2, space>> strain(1);
    dealii::FEValues<space> middle(mapping_, fe_, dealii::QMidpoint<space>(),
                                   dealii::update_gradients);
    Values told;
    for (const auto& cell : dofs_.active_cell_iterators()) {
      middle.reinit(cell);
      middle[dealii::FEValuesExtractors::Vector(0)].get_function_symmetric_gradients(motion,
                                                                                     strain);
      told.insert(told.end(), cells_.size() / mesh_.n_active_cells(), von_mises(strain[0]));
    }
    return {{"von_mises", told}};
  }

 private:
  using Node = std::array<dealii::types::global_dof_index, space>;  // its unknowns

  static unsigned order(const abut::Keys& keys) {
    const double degree = keys.get("degree", 1);
    if (degree != 1 && degree != 2) keys.refuse("degree", "must be 1 or 2", "Give one of these.");
    return static_cast<unsigned>(degree);
  }

  void make_mesh(const abut::Keys& keys) {
    if (keys.has("radius")) {
      dealii::GridGenerator::hyper_ball(mesh_, point(keys.numbers("centre", space, "m")),
                                        keys.positive("radius", "m"));
      mesh_.refine_global(static_cast<unsigned>(keys.count("refinements")));
      return;
    }
    const Values lengths = keys.numbers("lengths", space, "m"),
                 corner = keys.numbers("corner", space, "m"), cells = keys.numbers("cells", space);
    std::vector<unsigned> counts;
    Values opposite = corner;
    for (std::size_t c = 0; c < space; ++c) {
      if (cells[c] < 1 || cells[c] != std::floor(cells[c]))
        keys.refuse("cells", "must be whole numbers above 0", "Give one for each axis.");
      if (!(lengths[c] > 0)) keys.refuse("lengths", "must be above 0", "Give one for each axis.");
      counts.push_back(static_cast<unsigned>(cells[c]));
      opposite[c] += lengths[c];
    }
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh_, counts, point(corner), point(opposite),
                                                      true);
  }
  static dealii::Point<space> point(const Values& values) {
    dealii::Point<space> p;
    for (unsigned c = 0; c < space; ++c) p[c] = values[c];
    return p;
  }

  /// Nodes in the order in which cells have them, with places and unknowns, and what is drawn.
  void number_nodes() {
    std::vector<dealii::Point<space>> where(dofs_.n_dofs());
    dealii::DoFTools::map_dofs_to_support_points(mapping_, dofs_, where);
    const auto rank = dealii::FETools::hierarchic_to_lexicographic_numbering<space>(at(degree_));
    node_of_.assign(dofs_.n_dofs(), -1);
    std::vector<dealii::types::global_dof_index> own(fe_.dofs_per_cell);
    for (const auto& cell : dofs_.active_cell_iterators()) {
      cell->get_dof_indices(own);
      std::vector<int> lattice(rank.size());
      for (unsigned b = 0; b < rank.size(); ++b) {
        Node node{};
        for (unsigned c = 0; c < space; ++c) node[c] = own[fe_.component_to_system_index(c, b)];
        int& number = node_of_[node[0]];
        if (number < 0) {
          number = static_cast<int>(nodes_.size());
          nodes_.push_back(node);
          for (unsigned c = 0; c < space; ++c) places_.push_back(where[node[0]][c]);
        }
        lattice[rank[b]] = number;
      }
      draw(lattice);
    }
  }
  /// Cells of VTK between the nodes of a cell, which come x first.
  void draw(const std::vector<int>& lattice) {
    const int n = degree_ + 1;
    for (int k = 0; k < (space == 3 ? degree_ : 1); ++k)
      for (int j = 0; j < degree_; ++j)
        for (int i = 0; i < degree_; ++i) {
          std::vector<int> corners;
          for (int up = 0; up < space - 1; ++up) {
            const int low = i + n * (j + n * (k + up));
            for (const int each : {low, low + 1, low + n + 1, low + n})
              corners.push_back(lattice[at(each)]);
          }
          cells_.push_back({space == 2 ? 9 : 12, corners});
        }
  }

  /// A box shows its left or its right side, a ball all of its skin.
  void find_port(const abut::Keys& keys) {
    const bool ball = keys.has("radius");
    const std::string side = ball ? "all" : keys.text("side", "left");
    if (!ball && side != "left" && side != "right")
      keys.refuse("side", "must be left or right", "Give one of these.");
    const auto rank =
        dealii::FETools::hierarchic_to_lexicographic_numbering<space - 1>(at(degree_));
    std::vector<int> known(nodes_.size(), -1);
    std::vector<dealii::types::global_dof_index> own(fe_.dofs_per_face);
    for (const auto& cell : dofs_.active_cell_iterators())
      for (const unsigned f : cell->face_indices()) {
        if (!cell->face(f)->at_boundary()) continue;
        if (!ball && cell->face(f)->boundary_id() != (side == "left" ? 0 : 1)) continue;
        cell->face(f)->get_dof_indices(own);
        std::vector<int> lattice(rank.size());
        for (unsigned i = 0; i < own.size(); ++i) {
          const auto [c, b] = fe_.face_system_to_component_index(i, f);
          if (c != 0) continue;
          const int node = node_of_[own[i]];
          if (known[at(node)] < 0) {
            known[at(node)] = static_cast<int>(port_.size());
            port_.push_back(node);
          }
          lattice[rank[b]] = known[at(node)];
        }
        add_facets(lattice, cell->face(f)->center() - cell->center());
      }
  }
  /// Straight facets between the nodes of a face; `out` points from the body.
  void add_facets(const std::vector<int>& lattice, const dealii::Tensor<1, space>& out) {
    const int n = degree_ + 1;
    for (int j = 0; j < (space == 3 ? degree_ : 1); ++j)
      for (int i = 0; i < degree_; ++i) {
        const int low = i + n * j;
        std::vector<int> facet{lattice[at(low)], lattice[at(low + 1)]};
        if (space == 3) {
          facet.push_back(lattice[at(low + n + 1)]);
          facet.push_back(lattice[at(low + n)]);
        }
        if (looks(facet) * out < 0) std::reverse(facet.begin(), facet.end());
        facets_.push_back(facet);
      }
  }
  dealii::Tensor<1, space> looks(const std::vector<int>& facet) const {
    dealii::Tensor<1, space> a = place(facet[1]) - place(facet[0]);
    if constexpr (space == 2)
      return dealii::Point<2>(a[1], -a[0]);
    else
      return dealii::cross_product_3d(a, place(facet[3]) - place(facet[0]));
  }
  dealii::Point<space> place(int of_port) const {
    const auto first = places_.begin() + port_[at(of_port)] * space;
    return point({first, first + space});
  }

  void make_matrices(const abut::Keys& keys) {
    const double modulus = keys.positive("youngs_modulus", "Pa"),
                 ratio = keys.number("poissons_ratio"),
                 density = keys.positive("density", "kg/m^3");
    if (ratio <= -1 || ratio >= 0.5)
      keys.refuse("poissons_ratio", "must be above -1 and below 0.5", "Give such a number.");
    lame_ = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio));
    shear_ = modulus / (2 * (1 + ratio));
    dealii::DynamicSparsityPattern pattern(dofs_.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dofs_, pattern);
    pattern_.copy_from(pattern);
    stiffness_.reinit(pattern_);
    masses_.assign(dofs_.n_dofs(), 0.0);
    const dealii::QGauss<space> gauss(at(degree_) + 1);
    const dealii::QGaussLobatto<space> nodal(at(degree_) + 1);
    dealii::FEValues<space> values(mapping_, fe_, gauss,
                                   dealii::update_gradients | dealii::update_JxW_values);
    dealii::FEValues<space> lumps(mapping_, fe_, nodal,
                                  dealii::update_values | dealii::update_JxW_values);
    dealii::FullMatrix<double> local(fe_.dofs_per_cell, fe_.dofs_per_cell);
    std::vector<dealii::types::global_dof_index> own(fe_.dofs_per_cell);
    for (const auto& cell : dofs_.active_cell_iterators()) {
      cell->get_dof_indices(own);
      values.reinit(cell);
      stiffness_of(values, local);
      stiffness_.add(own, local);
      lumps.reinit(cell);
      for (unsigned i = 0; i < own.size(); ++i)
        for (const unsigned q : lumps.quadrature_point_indices())
          masses_[own[i]] += density * lumps.shape_value(i, q) * lumps.JxW(q);
      transit_ = transit_ > 0 ? std::min(transit_, shortest(cell)) : shortest(cell);
    }
    transit_ /= degree_ * std::sqrt((lame_ + 2 * shear_) / density);
    mass = 0;
    for (const auto& node : nodes_) mass += masses_[node[0]];
    surface_mass = mass;
    for (const int node : port_)
      surface_mass = std::min(surface_mass, masses_[nodes_[at(node)][0]]);
    stable_step = 2 / std::sqrt(fastest());
  }
  template <class Cell>
  static double shortest(const Cell& cell) {
    double length = cell->diameter();
    for (const unsigned line : cell->line_indices())
      length = std::min(length, cell->line(line)->diameter());
    return length;
  }

  void stiffness_of(const dealii::FEValues<space>& values,
                    dealii::FullMatrix<double>& local) const {
    const dealii::FEValuesExtractors::Vector motion(0);
    local = 0;
    for (const unsigned q : values.quadrature_point_indices())
      for (const unsigned i : values.dof_indices()) {
        const auto strain = values[motion].symmetric_gradient(i, q);
        const double swelling = values[motion].divergence(i, q);
        for (const unsigned j : values.dof_indices())
          local(i, j) += (2 * shear_ * (strain * values[motion].symmetric_gradient(j, q)) +
                          lame_ * swelling * values[motion].divergence(j, q)) *
                         values.JxW(q);
      }
  }

  double von_mises(const dealii::SymmetricTensor<2, space>& strain) const {
    std::array<double, 3> normal{};
    double sliding = 0.0;
    for (unsigned i = 0; i < 3; ++i) {
      normal[i] = lame_ * trace(strain) + (i < space ? 2 * shear_ * strain[i][i] : 0.0);
      for (unsigned j = 0; j < i && i < space; ++j)
        sliding += std::pow(2 * shear_ * strain[i][j], 2);
    }
    return std::sqrt(0.5 *
                         (std::pow(normal[0] - normal[1], 2) + std::pow(normal[1] - normal[2], 2) +
                          std::pow(normal[2] - normal[0], 2)) +
                     3 * sliding);
  }

  /// [1/s^2] the largest eigenvalue of M^-1 K, by powers of it.
  double fastest() const {
    Values x(masses_.size()), y;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::sin(1.0 + 2.0 * static_cast<double>(k));
    double value = 0.0;
    for (int i = 0; i < 200; ++i) {
      multiply(stiffness_, x, y);
      double length = 0.0, norm = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) {
        norm += masses_[k] * x[k] * x[k];
        y[k] /= masses_[k];
        length += masses_[k] * y[k] * y[k];
      }
      value = std::sqrt(length / norm);
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = y[k] / std::sqrt(length);
    }
    return value;
  }

  void kick(double dt, const Values& force) {
    for (std::size_t k = 0; k < v_.size(); ++k) v_[k] -= dt * pull_[k] / masses_[k];
    for (std::size_t k = 0; k < port_.size(); ++k)
      for (std::size_t c = 0; c < space; ++c) {
        const auto unknown = nodes_[at(port_[k])][c];
        v_[unknown] += dt * force[k * space + c] / masses_[unknown];
      }
  }

  Values of_port(const Values& all) const {
    Values values;
    for (const int node : port_)
      for (const auto unknown : nodes_[at(node)]) values.push_back(all[unknown]);
    return values;
  }
  Values in_space(const Values& all) const {
    Values values;
    for (const auto& node : nodes_)
      for (std::size_t c = 0; c < 3; ++c)
        values.push_back(c < std::size_t{space} ? all[node[c]] : 0.0);
    return values;
  }

  int degree_;
  dealii::Triangulation<space> mesh_;
  dealii::MappingQ1<space> mapping_;
  dealii::FESystem<space> fe_;
  dealii::DoFHandler<space> dofs_;
  std::vector<Node> nodes_;
  std::vector<int> node_of_;  // of unknowns along x
  std::vector<int> port_;     // nodes of the port, and its facets by their places here
  std::vector<std::vector<int>> facets_;
  Values places_;  // [m] (nodes, dim)
  std::vector<std::pair<int, std::vector<int>>> cells_;
  dealii::SparsityPattern pattern_;
  dealii::SparseMatrix<double> stiffness_;  // [N/m], per metre in the plane
  Values masses_;                           // [kg] of unknowns
  double lame_ = 0.0, shear_ = 0.0;         // [Pa]
  double transit_ = 0.0;                    // [s]
  Values u_, v_, pull_;                     // [m] [m/s] [N] of unknowns; pull_ is K u
};

int main(int argc, char** argv) {
  dealii::MultithreadInfo::set_thread_limit(1);
  return abut::serve(argc, argv, [](const abut::Keys& keys) -> std::unique_ptr<abut::Body> {
    if (keys.length(keys.has("radius") ? "centre" : "lengths") == 2)
      return std::make_unique<Solid<2>>(keys);
    return std::make_unique<Solid<3>>(keys);
  });
}
