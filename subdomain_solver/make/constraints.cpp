#include "subdomain_solver/make/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "base/index.hpp"
#include "subdomain_solver/make/expression.hpp"
#include "subdomain_solver/make/fields.hpp"

namespace abut {

namespace {

/// Of a plane side, relative to its size: mesh files have coordinates of ten digits or more.
constexpr double flatness = 1.0e-8;

/// An orthonormal frame whose first axis is along a direction.
Matrix3 frame_along(const std::vector<double>& direction) {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < direction.size(); ++i)
    first(static_cast<Eigen::Index>(i)) = direction[i];
  first.normalize();
  Matrix3 axes;
  if (direction.size() == 2) {
    axes << first(0), -first(1), 0.0, first(1), first(0), 0.0, 0.0, 0.0, 1.0;
    return axes;
  }
  Eigen::Index least = 0;
  first.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d second = (Eigen::Vector3d::Unit(least) - first(least) * first).normalized();
  const Eigen::Vector3d third(first(1) * second(2) - first(2) * second(1),
                              first(2) * second(0) - first(0) * second(2),
                              first(0) * second(1) - first(1) * second(0));
  axes << first, second, third;
  return axes;
}

Eigen::Vector3d point(const Mesh& mesh, std::int32_t node) {
  const std::array<double, 3> at = position_of(mesh, node);
  return {at[0], at[1], at[2]};
}

/// Unit normal of a plane side. Throws InputError, told of nothing, where it is not plane.
Eigen::Vector3d plane_normal(const Mesh& mesh, const std::string& side) {
  const std::vector<std::int32_t> first = mesh.nodes_of(mesh.side(side).front());
  const Eigen::Vector3d origin = point(mesh, first[0]);
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // of the end of a bar
  if (mesh.dim > 1) normal = point(mesh, first[1]) - origin;
  const double size = normal.norm();
  if (mesh.dim == 2) normal = {normal(1), -normal(0), 0.0};
  if (mesh.dim == 3) normal = normal.cross(Eigen::Vector3d(point(mesh, first[2]) - origin));
  normal.normalize();
  for (std::int32_t node : mesh.nodes_of(side)) {
    const Eigen::Vector3d arm = point(mesh, node) - origin;
    if (std::abs(normal.dot(arm)) > flatness * std::max(size, arm.norm()))
      throw InputError(fmt::format("is not plane: node {} lies {:g} m beside it", node + 1,
                                   std::abs(normal.dot(arm))),
                       "", "Give each plane part a side of its own, or use x, y, z.");
  }
  return normal;
}

}  // namespace

ConstraintSpec mirrored(const Mesh& mesh, ConstraintSpec spec) {
  const Eigen::Vector3d normal = plane_normal(mesh, spec.on);
  spec.symmetry = false;
  Eigen::Index axis = 0;
  if (normal.cwiseAbs().maxCoeff(&axis) >= 1.0 - flatness * flatness) {
    (axis == 0 ? spec.x : axis == 1 ? spec.y : spec.z) = std::string("0");
  } else {
    spec.direction.assign(normal.data(), normal.data() + mesh.dim);
  }
  return spec;
}

namespace {

class ConstraintMaker {
 public:
  /// step [s]: that of the integrator, or any without one.
  ConstraintMaker(const Mesh& mesh, const Place& place, double step)
      : mesh_(mesh), place_(place), step_(step) {}

  void add(const std::string& name, const ConstraintSpec& spec) {
    const std::string key = "constraints." + name;
    begin(name);
    const std::vector<std::int32_t> nodes =
        named(place_, key + ".on", [&] { return mesh_.nodes_of(spec.on); });
    if (!spec.direction.empty()) return add_inclined(spec, key, nodes);
    const std::string* texts[] = {&spec.x, &spec.y, &spec.z};
    constexpr const char* names[] = {".x", ".y", ".z"};
    for (int i = 0; i < 3; ++i) {
      const std::string& text = spec.fixed ? zero_ : *texts[i];
      if (text.empty() || (spec.fixed && i >= mesh_.dim)) continue;
      if (i >= mesh_.dim) {
        throw InputError("is a direction that the body does not have", place_.where(key + names[i]),
                         "Leave it out.");
      }
      const ScalarField value = expression(text, place_.where(key + (spec.fixed ? "" : names[i])));
      for (std::int32_t node : nodes) prescribe(node, i, value, key);
    }
  }

  Constraints take() {
    std::sort(made_.supports.begin(), made_.supports.end(),
              [](const Prescribed& a, const Prescribed& b) { return a.dof < b.dof; });
    return std::move(made_);
  }

 private:
  /// A support and a constraint may have one name: they are told as one.
  void begin(const std::string& name) {
    const auto same = [&name](const HeldCoordinates& h) { return h.name == name; };
    const auto at = std::find_if(made_.held.begin(), made_.held.end(), same);
    now_ = index(at - made_.held.begin());
    if (at == made_.held.end()) made_.held.push_back({name, {}});
  }

  void prescribe(std::int32_t node, int direction, const ScalarField& value,
                 const std::string& key) {
    const int dof = node * mesh_.dim + direction;
    const std::array<double, 3> at = position_of(mesh_, node);
    const auto [place, fresh] = by_dof_.emplace(dof, made_.supports.size());
    if (!fresh) {
      agree(
          made_.supports[place->second].value, [&](double t) { return value(at, t); }, node, key);
      return;
    }
    made_.held[now_].dofs.push_back(dof);
    made_.supports.push_back({dof, [at, value](double time) { return value(at, time); }});
  }

  /// Sides that meet share nodes: what both prescribe must agree, and is kept once. Looked at for a
  /// few times, in steps, that no formula has been made for.
  void agree(const std::function<double(double)>& first, const std::function<double(double)>& other,
             std::int32_t node, const std::string& key) const {
    for (const double steps : {0.0, 0.37, 11.3, 177.7}) {
      const double before = first(steps * step_), now = other(steps * step_);
      if (!(std::abs(before - now) > 1.0e-12 * std::max(std::abs(before), std::abs(now)))) continue;
      throw InputError(
          fmt::format("prescribes {:g} m where another constraint prescribes {:g} m, at node {} "
                      "and {:g} s",
                      now, before, node + 1, steps * step_),
          place_.where(key), "Let constraints of sides that meet agree where they meet.");
    }
  }

  void add_inclined(const ConstraintSpec& spec, const std::string& key,
                    const std::vector<std::int32_t>& nodes) {
    double length = 0.0;
    for (double d : spec.direction) length = std::hypot(length, d);
    if (spec.direction.size() != index(mesh_.dim) || !(length > 0.0)) {
      throw InputError("is no direction of the body", place_.where(key + ".direction"),
                       fmt::format("Give {} numbers that are not all zero.", mesh_.dim));
    }
    const Matrix3 axes = frame_along(spec.direction);
    const ScalarField value = expression(spec.value, place_.where(key + ".value"));
    for (std::int32_t node : nodes) {
      const bool shared = std::any_of(made_.frames.begin(), made_.frames.end(),
                                      [node](const NodeFrame& f) { return f.node == node; });
      bool other = false;
      for (int i = 0; i < mesh_.dim; ++i) other = other || by_dof_.contains(node * mesh_.dim + i);
      if (shared || other) {
        throw InputError(
            fmt::format("and another constraint prescribe node {} in directions that differ",
                        node + 1),
            place_.where(key), "Let sides with a direction share no node with other constraints.");
      }
      made_.frames.push_back({node, axes});
      prescribe(node, 0, value, key);
    }
  }

  const Mesh& mesh_;
  const Place& place_;
  const double step_;
  const std::string zero_ = "0";
  std::map<int, std::size_t> by_dof_;
  std::size_t now_ = 0;  // of the constraints, the one being made
  Constraints made_;
};

}  // namespace

Constraints make_constraints(const BodySpec& spec, const Place& place, const Mesh& mesh) {
  const auto step_of = [](const auto& scheme) { return scheme.step; };
  const double step = spec.integrator ? std::visit(step_of, *spec.integrator) : 1.0;
  ConstraintMaker constraints(mesh, place, step);
  ConstraintSpec held;  // an end of a bar
  held.fixed = true;
  for (const auto& [side, is_fixed] :
       {std::pair("left", spec.supports.left_fixed), {"right", spec.supports.right_fixed}}) {
    held.on = side;
    if (is_fixed) constraints.add(side, held);
  }
  std::vector<std::pair<std::string, ConstraintSpec>> all = spec.constraints;
  for (auto& [name, constraint] : all) {
    const auto turn = [&mesh, &told = constraint] { return mirrored(mesh, told); };
    if (constraint.symmetry) constraint = named(place, "constraints." + name + ".on", turn);
  }
  std::stable_partition(all.begin(), all.end(), [](const auto& c) {
    return c.second.direction.empty();  // frames come last: they refuse others
  });
  for (const auto& [name, constraint] : all) constraints.add(name, constraint);
  return constraints.take();
}

}  // namespace abut
