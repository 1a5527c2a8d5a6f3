#include "coordinator/coupling/tied_port.hpp"

#include <algorithm>
#include <utility>

#include "coordinator/coupling/kernel_support.hpp"

namespace abut {

TiedPort::TiedPort(const TieLayout& layout, const TieLayout::Part& part, const TieKernel& kernel,
                   int port, const std::vector<std::int32_t>& points, Bodies& bodies)
    : steps_(layout.blocks) {
  const PortGeometry& surface = bodies.port({part.body, port}).geometry;
  const std::size_t dim = index(surface.dim);
  for (std::size_t v = 0; v < (points.empty() ? surface.points.size() : points.size() * dim); ++v)
    values_.push_back(points.empty() ? v : index(points[v / dim]) * dim + v % dim);
  give_.points = points;
  probe(layout, part, port, bodies);
  find_give(layout, kernel);
}

void TiedPort::probe(const TieLayout& layout, const TieLayout::Part& part, int port,
                     Bodies& bodies) {
  const std::size_t width = bodies.port({part.body, port}).geometry.points.size();
  const auto count = static_cast<Eigen::Index>(values_.size());
  std::vector<double> units(values_.size() * width, 0.0);
  for (std::size_t k = 0; k < values_.size(); ++k) units[k * width + values_[k]] = 1.0;
  std::vector<double> moved;
  for (const TieLayout::End& end : part.ends) {
    const TieRows& rows = layout.rows(end);
    const SparseRows& side = rows.of[end.side];
    const int tied = layout.side(end).port;
    End& to = ends_.emplace_back();
    to.member = end.member;
    to.sign = end.side == layout.members[end.member].joint->role.kinematic ? 1.0 : -1.0;
    const int seen[] = {tied};
    const PortKernel out = for_levels(bodies.probe(part.body, port, units, steps_, seen));
    moved.resize(index(rows.width()));
    for (int l = 0; l < steps_; ++l) {
      Eigen::MatrixXd& at = to.rows.emplace_back(rows.width(), count);
      for (Eigen::Index k = 0; k < count; ++k) {
        const std::size_t from = (index(l) * values_.size() + index(k)) * index(out.width);
        apply(side, rows.dim, std::span(out.displacement).subspan(from, index(out.width)), moved);
        at.col(k) = Eigen::Map<const Eigen::VectorXd>(moved.data(), rows.width());
      }
    }
    const std::size_t tied_width = bodies.port({part.body, tied}).geometry.points.size();
    std::vector<double> forces(index(rows.width()) * tied_width, 0.0);
    for (int k = 0; k < rows.width(); ++k) {
      std::vector<double> unit(index(rows.width()), 0.0);
      unit[k] = 1.0;
      rows.press(end.side, 1.0, unit,
                 std::span(forces).subspan(index(k) * tied_width, tied_width));
    }
    const int touching[] = {port};
    const PortKernel in = bodies.probe(part.body, tied, forces, steps_, touching);
    require_for_substeps(in, layout.side(end), layout.other_side(end), bodies);
    give_.step = in.step;
    for (int l = 0; l < steps_; ++l) {
      Eigen::MatrixXd& at = to.port.emplace_back(count, rows.width());
      for (int k = 0; k < rows.width(); ++k)
        for (Eigen::Index v = 0; v < count; ++v)
          at(v, k) = in.displacement[(index(l * rows.width() + k)) * width + values_[v]];
    }
  }
}

/// Forces that hold the ties together under a force on the port, and what they move there.
void TiedPort::find_give(const TieLayout& layout, const TieKernel& kernel) {
  const auto count = static_cast<Eigen::Index>(values_.size());
  give_.support = ForceSupport::nodal;
  give_.patterns = give_.width = static_cast<int>(count);
  give_.displacement.assign(index(steps_) * give_.per_step(), 0.0);
  give_.begin = give_.displacement;
  Eigen::VectorXd jump(layout.blocks * layout.size);
  for (Eigen::Index k = 0; k < count; ++k) {
    jump.setZero();
    for (const End& end : ends_) {
      const TieLayout::Member& member = layout.members[end.member];
      for (int l = 0; l < steps_; ++l)
        jump.segment(l * layout.size + member.inner, member.width) += end.sign * end.rows[l].col(k);
    }
    if (jump.isZero(0.0)) continue;
    const Eigen::VectorXd force = -kernel.solve(jump);
    for (int l = 0; l < steps_; ++l) {
      Eigen::Map<Eigen::VectorXd> moved(
          &give_.displacement[index(l) * give_.per_step() + index(k * count)], count);
      for (const End& end : ends_) {
        const TieLayout::Member& member = layout.members[end.member];
        for (int a = 0; a <= l; ++a)
          moved += end.sign * end.port[l - a] *
                   force.segment(a * layout.size + member.inner, member.width);
      }
    }
  }
}

void TiedPort::follow(const TieLayout& layout, const Eigen::VectorXd& change, int width,
                      Eigen::Ref<Eigen::VectorXd> motion) const {
  for (const End& end : ends_) {
    const TieLayout::Member& member = layout.members[end.member];
    for (int l = 0; l < std::min(steps_, layout.blocks); ++l) {  // windows may be cut short
      for (int a = 0; a <= l; ++a) {
        const Eigen::VectorXd moved =
            end.sign * end.port[l - a] *
            change.segment(member.first + Eigen::Index{a} * member.width, member.width);
        for (std::size_t v = 0; v < values_.size(); ++v)
          motion[Eigen::Index{l} * width + static_cast<Eigen::Index>(values_[v])] +=
              moved[static_cast<Eigen::Index>(v)];
      }
    }
  }
}

}  // namespace abut
