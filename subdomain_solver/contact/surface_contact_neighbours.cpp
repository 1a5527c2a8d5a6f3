// What bodies that are tied to this one add to how its surfaces give way.

#include <algorithm>

#include "subdomain_solver/contact/surface_contact.hpp"

namespace abut {

/// A compliance and that of tied neighbours.
class SurfaceContact::Eased final : public Compliance {
 public:
  Eased(const std::vector<Own>& surfaces, std::size_t coordinates, Compliance& own)
      : surfaces_(surfaces), own_(own), columns_(coordinates) {}

  const Vector* column(int k) override {
    Vector& out = columns_[k];
    if (out.size() > 0) return &out;
    const Vector* own = own_.column(k);
    if (own == nullptr) return nullptr;
    out = *own;
    for (const Own& surface : surfaces_) {
      if (!surface.neighbours.act()) continue;
      const auto at = std::ranges::find(surface.at, k);
      if (at == surface.at.end()) continue;
      const std::span<const double> moved =
          surface.neighbours.response(static_cast<std::size_t>(at - surface.at.begin()));
      for (std::size_t v = 0; v < moved.size(); ++v) out(surface.at[v]) += moved[v];
    }
    return &out;
  }

  bool apply(const Vector& force, Vector& moved) override {
    if (!own_.apply(force, moved)) return false;
    for (const Own& surface : surfaces_) {
      if (!surface.neighbours.act()) continue;
      for (std::size_t at = 0; at < surface.at.size(); ++at) {
        const double pressed = force(surface.at[at]);
        if (pressed == 0.0) continue;
        const std::span<const double> more = surface.neighbours.response(at);
        for (std::size_t v = 0; v < more.size(); ++v) moved(surface.at[v]) += pressed * more[v];
      }
    }
    return true;
  }

  std::size_t version() const override { return own_.version(); }

 private:
  const std::vector<Own>& surfaces_;
  Compliance& own_;
  std::vector<Vector> columns_;
};

/// [N] (values) of all partners, along the axes of space.
std::span<const double> SurfaceContact::pressing(const Own& own) {
  sum_.assign(own.at.size(), 0.0);
  for (const Meeting& m : meetings_) {
    if (&surfaces_[m.own] != &own) continue;
    for (std::size_t v = 0; v < sum_.size(); ++v) sum_[v] += pressed_[m.pressed + v];
  }
  return sum_;
}

/// Sides along axes of their own know no components along those of space.
void SurfaceContact::begin_neighbours(const Window& window) {
  for (Own& own : surfaces_) {
    const auto turned = [](const Matrix3* frame) { return frame != nullptr; };
    const PortKernel& kernel = window.neighbours[own.surface.port];
    if (kernel.count() > 0 && acts(own.surface.port) &&
        std::ranges::none_of(own.surface.frames, turned))
      own.neighbours.begin(kernel, window.grid, window.request.boundary[own.surface.port].balanced);
    else
      own.neighbours.rest();
  }
}

const Vector* SurfaceContact::solve(double time, const Vector& free, Compliance& give) {
  const auto act = [](const Own& own) { return own.neighbours.act(); };
  if (std::ranges::none_of(surfaces_, act)) return solve_rows(time, free, give);
  eased_ = free;
  for (const Own& own : surfaces_) {
    if (!own.neighbours.act()) continue;
    const std::span<const double> moved = own.neighbours.moved();
    for (std::size_t v = 0; v < moved.size(); ++v) eased_(own.at[v]) += moved[v];
  }
  Eased eased(surfaces_, dofs_.size(), give);
  near_give_.forget();
  const Vector* force = solve_rows(time, eased_, eased);
  near_give_.forget();
  return force;
}

}  // namespace abut
