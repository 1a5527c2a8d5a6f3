#include "subdomain_solver/contact/point_contact.hpp"

#include <algorithm>
#include <cmath>

#include "contract/kernel_misfit.hpp"

namespace abut {

namespace {

/// Two ends of one body see each other by the compliance between them, which is less than their
/// own: sweeps over them end soon.
constexpr int most_point_sweeps = 100;

/// Of a substep: times nearer to its end than this are its end, rounded.
constexpr double point_rounding = 1.0e-6;

}  // namespace

PointContact::PointContact(const std::vector<Point>& points, double step, const std::string& body)
    : step_(step) {
  for (const Point& p : points) ends_.push_back({p, {p.place, p.outward, body}, {}});
  std::sort(ends_.begin(), ends_.end(),
            [](const End& a, const End& b) { return a.point.dof < b.point.dof; });
}

void PointContact::impose(const Window& window) {
  dofs_.clear();
  acting_.clear();
  grid_ = window.grid;
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    const std::size_t port = ends_[k].point.port;
    ends_[k].obstacle.impose(window.request.boundary[port], window.partners[port], window.grid);
    if (!ends_[k].obstacle.acts()) continue;
    acting_.push_back(k);
    dofs_.push_back(ends_[k].point.dof);
  }
}

bool PointContact::has(std::size_t port) const {
  return std::ranges::any_of(ends_, [port](const End& e) { return e.point.port == port; });
}

bool PointContact::acts(std::size_t port) const {
  return std::ranges::any_of(acting_,
                             [this, port](std::size_t k) { return ends_[k].point.port == port; });
}

void PointContact::aim(int i, const std::vector<double>& forces, const std::vector<double>&) {
  aim_ = i == 0 ? grid_.begin : grid_.time(i);
  for (const std::size_t k : acting_)
    ends_[k].surface = ends_[k].obstacle.at(i, -forces[ends_[k].point.port]);
}

void PointContact::hold(const std::vector<double>& forces, std::vector<double>& now) const {
  for (const std::size_t k : acting_) now[ends_[k].point.port] = forces[ends_[k].point.port];
}

void PointContact::react(std::size_t port, std::size_t, const std::vector<double>& forces,
                         std::vector<double>& out) const {
  out.push_back(-forces[port]);
}

std::string PointContact::misfit(std::size_t port, const PortKernel& kernel) const {
  if (!has(port)) return "this port takes no obstacles";
  return misfit_of(kernel, step_, ForceSupport::nodal, 1);
}

void PointContact::settle(std::vector<double>& forces) {
  for (std::size_t k = 0; k < acting_.size(); ++k)
    forces[ends_[acting_[k]].point.port] = force_(static_cast<Eigen::Index>(k));
}

/// Force along x on one end [N] that lies at `free` without it [M.20].
double PointContact::push(const End& end, bool in_substep, double time, double free,
                          double compliance) const {
  const PointObstacle::Surface surface = in_substep ? end.obstacle.between(time) : end.surface;
  const double overlap = end.point.outward * free - surface.target;
  const double pressure = overlap / (compliance + surface.give);
  return -end.point.outward * (surface.bilateral ? pressure : std::max(0.0, pressure));
}

const Vector* PointContact::solve(double time, const Vector& free, Compliance& give) {
  const bool in_substep = std::abs(time - aim_) > point_rounding * grid_.step;
  force_.setZero(free.size());
  for (int sweep = 0; sweep < most_point_sweeps; ++sweep) {
    double change = 0.0;
    for (Eigen::Index k = 0; k < free.size(); ++k) {
      const Vector* column = give.column(static_cast<int>(k));  // symmetric: its row too
      if (column == nullptr) return nullptr;
      const double own = (*column)(k), others = column->dot(force_) - own * force_(k);
      const double now = push(ends_[acting_[k]], in_substep, time, free(k) + others, own);
      change = std::max(change, std::abs(now - force_(k)));
      force_(k) = now;
    }
    if (change <= 1.0e-15 * force_.lpNorm<Eigen::Infinity>() || free.size() == 1) break;
  }
  return &force_;
}

}  // namespace abut
