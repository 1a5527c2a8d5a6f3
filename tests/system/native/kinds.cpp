// Bodies of abut.hpp that the examples are not: without inertia, in space, of several ports, with
// what a body may say itself. Which of them is told by the key `kind`.
#include <abut.hpp>

#include <cmath>

using abut::Values;

/// A spring without inertia.
struct Spring : abut::Body {
  explicit Spring(const abut::Keys& keys) : stiffness(keys.positive("stiffness", "N/m")) {
    model = "spring";
    mass = 0.0;
    quasi_static = conserves = linear = true;
    substep = 1.0e-3;
    state = {{"u", u}};
  }
  std::vector<abut::Surface> surface() override { return {abut::Point(0.0, 1.0)}; }
  void step(double, const Values& force) override { u = force[0] / stiffness; }
  abut::Energy energy() override { return {0.0, 0.5 * stiffness * u * u, 0.0, 0.0}; }

  double u = 0.0, stiffness;
};

/// A box that floats without turning; its surface is of quadrilaterals and two triangles.
struct Box : abut::Body {
  explicit Box(const abut::Keys&) {
    dim = 3;
    model = "box";
    mass = 2.0;
    substep = 1.0e-4;
    conserves = linear = true;
    for (int k = 0; k < 8; ++k)
      for (const bool far : {(k & 1) != 0, (k & 2) != 0, (k & 4) != 0})
        corners.push_back(far ? 1.0 : 0.0);
  }
  std::vector<abut::Surface> surface() override {
    return {{corners,
             {{0, 4, 6, 2},
              {1, 3, 7, 5},
              {0, 1, 5, 4},
              {2, 6, 7, 3},
              {0, 2, 3, 1},
              {4, 5, 7},
              {4, 7, 6}}}};
  }
  void step(double dt, const Values& force) override {
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (std::size_t k = i; k < force.size(); k += 3) sum += force[k];
      const double before = v[i];
      v[i] += dt * sum / mass;
      u[i] += dt * (before + v[i]) / 2;
    }
  }
  Values displacement() override { return on_all(u); }
  Values velocity() override { return on_all(v); }
  Values save() override { return {u[0], u[1], u[2], v[0], v[1], v[2]}; }
  void restore(const Values& saved) override {
    for (std::size_t i = 0; i < 3; ++i) u[i] = saved[i], v[i] = saved[3 + i];
  }
  double speed_bound() override { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
  abut::Grid grid() override { return {corners, {{11, {0, 1, 2, 3, 4, 5, 6, 7}}}}; }  // 11: a voxel
  abut::Fields node_fields() override { return {{"height", Values(8, u[2])}}; }
  abut::Fields cell_fields() override { return {{"velocity", {v[0], v[1], v[2]}}}; }

  static Values on_all(const double (&of)[3]) {
    Values all;
    for (int k = 0; k < 8; ++k) all.insert(all.end(), of, of + 3);
    return all;
  }
  Values corners;
  double u[3] = {}, v[3] = {};
};

/// Two masses and the spring between them; its kernel and the work on its ports are its own words.
struct TwoEnds : abut::Body {
  explicit TwoEnds(const abut::Keys& keys)
      : stiffness(keys.get("stiffness", 1.0e5, "N/m")), breaks(keys.get("breaks", 1.0e9, "m")) {
    model = keys.text("name", "two ends");
    mass = 2.0e-4;
    substep = 1.0e-6;
    conserves = linear = true;
    state = {{"u", u}, {"v", v}};
  }
  std::vector<abut::Surface> surface() override {
    return {abut::Point(-0.01, -1.0, "left"), abut::Point(0.09, 1.0, "right")};
  }
  void step(double dt, const Values& force) override {
    const Values before = u;
    kick(dt / 2, force);
    for (const std::size_t i : {0u, 1u}) u[i] += dt * v[i];
    kick(dt / 2, force);
    for (const std::size_t i : {0u, 1u}) through[i] = force[i] * (u[i] - before[i]);
    if (std::abs(u[1] - u[0]) > breaks) throw abut::NotConverged("the spring has broken");
  }
  void kick(double dt, const Values& force) {
    const double pull = stiffness * (u[1] - u[0]);
    v[0] += dt * (force[0] + pull) / (mass / 2);
    v[1] += dt * (force[1] - pull) / (mass / 2);
  }
  Values work() override { return through; }
  abut::Energy energy() override {
    return {mass / 4 * (v[0] * v[0] + v[1] * v[1]), 0.5 * stiffness * (u[1] - u[0]) * (u[1] - u[0]),
            0.0, 0.0};
  }
  Values momentum() override { return {mass / 2 * (v[0] + v[1])}; }
  Values kernel(int port, int patterns, const Values& force, double dt, int count) override {
    const Values now_u = u, now_v = v;
    Values all;
    for (int k = 0; k < count; ++k) all.resize(all.size() + static_cast<std::size_t>(patterns));
    for (std::size_t p = 0; p < force.size(); ++p) {
      u = v = Values(2, 0.0);
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        Values pushed(2, 0.0);
        pushed[static_cast<std::size_t>(port)] = k == 0 ? force[p] : 0.0;
        step(dt, pushed);
        all[k * static_cast<std::size_t>(patterns) + p] = u[static_cast<std::size_t>(port)];
      }
    }
    u = now_u, v = now_v;
    return all;
  }

  double stiffness, breaks;
  Values u = Values(2, 0.0), v = Values(2, 0.0), through = Values(2, 0.0);
};

int main(int argc, char** argv) {
  return abut::serve(argc, argv, [](const abut::Keys& keys) -> std::unique_ptr<abut::Body> {
    const std::string kind = keys.text("kind");
    if (kind == "spring") return std::make_unique<Spring>(keys);
    if (kind == "box") return std::make_unique<Box>(keys);
    if (kind == "two_ends") return std::make_unique<TwoEnds>(keys);
    keys.refuse("kind", "is none", "Give spring, box or two_ends.");
  });
}
