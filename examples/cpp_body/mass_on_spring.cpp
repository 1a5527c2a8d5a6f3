// A mass on a spring as a body of abut.
// usage: mass_on_spring --connect ENDPOINT --body NAME      (README.md beside this file)
#include <abut.hpp>

#include <cmath>

/// Turns on its spring, exactly, about where the force of a substep holds it.
class Mass : public abut::Body {
 public:
  explicit Mass(const abut::Keys& keys)
      : stiffness_(keys.positive("stiffness", "N/m")), position_(keys.number("position", "m")) {
    model = "mass on a spring, in C++";
    mass = keys.positive("mass", "kg");
    substep = keys.positive("step", "s");
    omega_ = std::sqrt(stiffness_ / mass);
    state = {{"u", u_}, {"v", v_}};
    conserves = linear = true;
  }

  std::vector<abut::Surface> surface() override { return {abut::Point(position_, -1.0)}; }

  void step(double dt, const abut::Values& force) override {
    const double rest = force[0] / stiffness_, c = std::cos(omega_ * dt), s = std::sin(omega_ * dt);
    const double away = u_ - rest;
    u_ = rest + c * away + s * v_ / omega_;
    v_ = c * v_ - s * omega_ * away;
  }

  abut::Energy energy() override {
    return {0.5 * mass * v_ * v_, 0.5 * stiffness_ * u_ * u_, 0.0, 0.0};
  }
  double speed_bound() override { return std::hypot(v_, omega_ * u_); }

 private:
  double stiffness_, position_, omega_ = 0.0;  // [N/m] [m] [1/s]
  double u_ = 0.0, v_ = 0.0;                   // [m] [m/s]
};

int main(int argc, char** argv) { return abut::serve<Mass>(argc, argv); }
