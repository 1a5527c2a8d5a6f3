// Many rigid boxes as one body of abut; what they do to each other is Bullet's (libbullet-dev).
// usage: boxes --connect ENDPOINT --body NAME      (README.md beside this file)
#include <abut.hpp>

#include <btBulletDynamicsCommon.h>

#include <array>
#include <cmath>

using abut::Values;

namespace {

using Vector = std::array<double, 3>;

btVector3 floats(const double* of) {
  return {static_cast<btScalar>(of[0]), static_cast<btScalar>(of[1]), static_cast<btScalar>(of[2])};
}

/// A world of Bullet that lives for one step: Bullet remembers contacts from step to step, and what
/// a step does here must follow from the state alone.
struct World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btRigidBody>> boxes;

  World() {
    world.setGravity({0, 0, 0});
    btContactSolverInfo& how = world.getSolverInfo();
    how.m_erp = how.m_erp2 = 0;  // velocities alone: what pushes boxes apart would make energy
    how.m_splitImpulse = 0;
    how.m_numIterations = 200;
  }
  ~World() {
    for (const auto& box : boxes) world.removeRigidBody(box.get());
  }
};

}  // namespace

/// Boxes in a lattice that touch and do not stick; blows between them are inelastic.
class Boxes : public abut::Body {
 public:
  explicit Boxes(const abut::Keys& keys) {
    dim = 3;
    model = "rigid boxes, Bullet " + std::to_string(btGetVersion());
    substep = keys.positive("step", "s");
    edge_ = keys.positive("edge", "m");
    const Values first = keys.numbers("corner", 3, "m"), counts = keys.numbers("boxes", 3);
    const Values velocity = keys.numbers("velocity", 3, "m/s");
    for (int i = 0; i < counts[0]; ++i)
      for (int j = 0; j < counts[1]; ++j)
        for (int k = 0; k < counts[2]; ++k)
          for (const double at : {first[0] + (i + 0.5) * edge_, first[1] + (j + 0.5) * edge_,
                                  first[2] + (k + 0.5) * edge_})
            centres_.push_back(at);
    const std::size_t n = centres_.size() / 3;
    if (n == 0) keys.refuse("boxes", "are none", "Give counts above 0 along all axes.");
    box_mass_ = keys.positive("density", "kg/m^3") * edge_ * edge_ * edge_;
    mass = static_cast<double>(n) * box_mass_;
    surface_mass = box_mass_ / 5.5;  // of a corner that is pushed through it: r^2 m / I is 4.5
    way_.assign(3 * n, 0.0);
    spin_.assign(3 * n, 0.0);
    for (std::size_t b = 0; b < n; ++b) {
      turned_.insert(turned_.end(), {0.0, 0.0, 0.0, 1.0});
      speed_.insert(speed_.end(), velocity.begin(), velocity.end());
    }
    lost_ = {0.0};
    state = {
        {"way", way_}, {"turned", turned_}, {"speed", speed_}, {"spin", spin_}, {"lost", lost_}};
  }

  /// A port of every box, box_1 and so on: six sides, counterclockwise from outside.
  std::vector<abut::Surface> surface() override {
    std::vector<abut::Surface> all;
    const Values points = corners();
    for (std::size_t b = 0; b < count(); ++b) {
      const auto first = points.begin() + static_cast<std::ptrdiff_t>(24 * b);
      all.push_back(
          {{first, first + 24},
           {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}},
           "box_" + std::to_string(b + 1)});
    }
    return all;
  }

  void step(double dt, const Values& force) override {
    World bullet;
    btBoxShape shape(btVector3(1, 1, 1) * static_cast<btScalar>(edge_ / 2));
    const auto m = static_cast<btScalar>(box_mass_);
    for (std::size_t b = 0; b < count(); ++b) add(bullet, shape, m, b);
    const Values from = corners();
    const double before = kinetic();
    for (std::size_t b = 0; b < count(); ++b)
      for (std::size_t p = 24 * b; p < 24 * (b + 1); p += 3) {
        Vector arm{};
        for (std::size_t i = 0; i < 3; ++i)
          arm[i] = from[p + i] - centres_[3 * b + i] - way_[3 * b + i];
        bullet.boxes[b]->applyForce(floats(&force[p]), floats(arm.data()));
      }
    bullet.world.stepSimulation(static_cast<btScalar>(dt), 0);
    for (std::size_t b = 0; b < count(); ++b) take(*bullet.boxes[b], b, dt);
    const Values to = corners();
    double work = 0.0;
    for (std::size_t k = 0; k < to.size(); ++k) work += force[k] * (to[k] - from[k]);
    lost_[0] += work + before - kinetic();
  }

  Values displacement() override {
    Values u = corners();
    const Values from = corners_of(Values(way_.size(), 0.0), upright());
    for (std::size_t k = 0; k < u.size(); ++k) u[k] -= from[k];
    return u;
  }
  Values velocity() override {
    Values v = corners();
    for (std::size_t b = 0; b < count(); ++b)
      for (std::size_t p = 24 * b; p < 24 * (b + 1); p += 3) {
        Vector r{};
        for (std::size_t i = 0; i < 3; ++i) r[i] = v[p + i] - centres_[3 * b + i] - way_[3 * b + i];
        const double *w = &spin_[3 * b], *s = &speed_[3 * b];
        v[p] = s[0] + w[1] * r[2] - w[2] * r[1];
        v[p + 1] = s[1] + w[2] * r[0] - w[0] * r[2];
        v[p + 2] = s[2] + w[0] * r[1] - w[1] * r[0];
      }
    return v;
  }
  abut::Energy energy() override { return {kinetic(), 0.0, lost_[0], 0.0}; }
  Values momentum() override {
    Values all(3, 0.0);
    for (std::size_t k = 0; k < speed_.size(); ++k) all[k % 3] += box_mass_ * speed_[k];
    return all;
  }

 private:
  std::size_t count() const { return centres_.size() / 3; }
  Values upright() const {
    Values all;
    for (std::size_t b = 0; b < count(); ++b) all.insert(all.end(), {0.0, 0.0, 0.0, 1.0});
    return all;
  }

  void add(World& bullet, btBoxShape& shape, btScalar m, std::size_t b) const {
    const auto inertia = static_cast<btScalar>(box_mass_ * edge_ * edge_ / 6);
    btRigidBody::btRigidBodyConstructionInfo info(m, nullptr, &shape, btVector3(1, 1, 1) * inertia);
    info.m_friction = 0;
    bullet.boxes.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& box = *bullet.boxes.back();
    const double* q = &turned_[4 * b];
    const Vector at{centres_[3 * b] + way_[3 * b], centres_[3 * b + 1] + way_[3 * b + 1],
                    centres_[3 * b + 2] + way_[3 * b + 2]};
    box.setWorldTransform(
        btTransform(btQuaternion(static_cast<btScalar>(q[0]), static_cast<btScalar>(q[1]),
                                 static_cast<btScalar>(q[2]), static_cast<btScalar>(q[3])),
                    floats(at.data())));
    box.setLinearVelocity(floats(&speed_[3 * b]));
    box.setAngularVelocity(floats(&spin_[3 * b]));
    box.setActivationState(DISABLE_DEACTIVATION);
    bullet.world.addRigidBody(&box);
  }

  /// Velocities are Bullet's, in single precision; ways are summed here, in double.
  void take(const btRigidBody& box, std::size_t b, double dt) {
    double *w = &spin_[3 * b], *q = &turned_[4 * b];
    for (int i = 0; i < 3; ++i) {
      speed_[3 * b + static_cast<std::size_t>(i)] = box.getLinearVelocity()[i];
      w[i] = box.getAngularVelocity()[i];
      way_[3 * b + static_cast<std::size_t>(i)] += dt * box.getLinearVelocity()[i];
    }
    const double rate = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), half = rate * dt / 2;
    if (rate == 0.0) return;
    const double s = std::sin(half) / rate, c = std::cos(half);
    const std::array<double, 4> p{s * w[0], s * w[1], s * w[2], c};
    const std::array<double, 4> o{q[0], q[1], q[2], q[3]};
    q[0] = p[3] * o[0] + p[0] * o[3] + p[1] * o[2] - p[2] * o[1];
    q[1] = p[3] * o[1] + p[1] * o[3] + p[2] * o[0] - p[0] * o[2];
    q[2] = p[3] * o[2] + p[2] * o[3] + p[0] * o[1] - p[1] * o[0];
    q[3] = p[3] * o[3] - p[0] * o[0] - p[1] * o[1] - p[2] * o[2];
  }

  Values corners() const { return corners_of(way_, turned_); }
  /// [m] (8 boxes, 3); a corner's number in binary tells its sides.
  Values corners_of(const Values& way, const Values& turned) const {
    Values all;
    for (std::size_t b = 0; b < count(); ++b) {
      const double x = turned[4 * b], y = turned[4 * b + 1], z = turned[4 * b + 2],
                   w = turned[4 * b + 3];
      const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                              {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                              {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
      for (int c = 0; c < 8; ++c) {
        const double arm[3] = {(c & 4) != 0 ? 0.5 : -0.5, (c & 2) != 0 ? 0.5 : -0.5,
                               (c & 1) != 0 ? 0.5 : -0.5};
        for (std::size_t i = 0; i < 3; ++i)
          all.push_back(centres_[3 * b + i] + way[3 * b + i] +
                        edge_ * (r[i][0] * arm[0] + r[i][1] * arm[1] + r[i][2] * arm[2]));
      }
    }
    return all;
  }
  double kinetic() const {
    double sum = 0.0;
    for (const double s : speed_) sum += 0.5 * box_mass_ * s * s;
    for (const double w : spin_) sum += 0.5 * box_mass_ * edge_ * edge_ / 6 * w * w;
    return sum;
  }

  double edge_, box_mass_ = 0.0;   // [m] [kg]
  Values centres_, way_, turned_;  // [m] (boxes, 3), [m], quaternions (boxes, 4)
  Values speed_, spin_, lost_;     // [m/s] [rad/s] (boxes, 3), [J] in blows
};

int main(int argc, char** argv) { return abut::serve<Boxes>(argc, argv); }
