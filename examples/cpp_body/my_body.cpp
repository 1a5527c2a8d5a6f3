// A solid in the plane as a body of abut: copy it and put your own solver in its place.
// usage: my_body --connect ENDPOINT --body NAME      (README.md beside this file)
//
// The order of calls, and which part of yours belongs where:
//
//     Plate(keys)       read your keys, your mesh; build mass and stiffness; set the initial state
//     surface()         the points and facets of your boundary that may touch others
//     step(dt, force)   one step of your integrator; `force` [N] on the points of surface() is
//                       constant in it. After it the state is at the step's end
//     displacement(), velocity()    of the points of surface(), now
//     energy(), momentum()          of the whole body, now
//     save(), restore()             what `state` names: everything that step() changes!
//                                   A window comes again with other forces until both bodies agree
//     node_fields()                 what pictures show
#include <abut.hpp>

#include <array>
#include <cmath>

using abut::Values;

/// A rectangle of four-node cells in plane strain, central difference.
class Plate : public abut::Body {
 public:
  explicit Plate(const abut::Keys& keys)
      : nx_(whole(keys, 0)), ny_(whole(keys, 1)), lengths_(keys.numbers("lengths", 2, "m")) {
    dim = 2;
    model = "plate of four-node cells, in C++";
    substep = keys.positive("step", "s");
    const double density = keys.positive("density", "kg/m^3");
    make_mesh(keys.numbers("corner", 2, "m"));
    make_cell(keys.positive("youngs_modulus", "Pa"), keys.number("poissons_ratio"), density);
    mass = density * lengths_[0] * lengths_[1];  // [kg/m]
    masses_.assign(points_.size() / 2, 0.0);
    for (const auto& cell : cells_)
      for (const int node : cell) masses_[at(node)] += mass / (4.0 * nx_ * ny_);
    const Values velocity = keys.numbers("velocity", 2, "m/s");
    u_.assign(points_.size(), 0.0);
    for (std::size_t k = 0; k < points_.size(); ++k) v_.push_back(velocity[k % 2]);
    state = {{"u all", u_}, {"v all", v_}};
    conserves = linear = true;
  }

  /// The left side, from above down: the body lies to the left.
  std::vector<abut::Surface> surface() override {
    abut::Surface face{of_face(points_), {}};
    for (int k = 0; k < ny_; ++k) face.facets.push_back({k, k + 1});
    face.transit = transit_;
    return {face};
  }

  void step(double dt, const Values& force) override {
    kick(dt / 2, force);
    for (std::size_t k = 0; k < u_.size(); ++k) u_[k] += dt * v_[k];
    kick(dt / 2, force);
  }

  Values displacement() override { return of_face(u_); }
  Values velocity() override { return of_face(v_); }

  /// What central differences conserve: velocities before and after a level, multiplied.
  abut::Energy energy() override {
    const Values pull = pulled();
    abut::Energy energy{};
    for (std::size_t k = 0; k < u_.size(); ++k) {
      const double change = substep / 2 * pull[k] / masses_[k / 2];
      energy.kinetic += 0.5 * masses_[k / 2] * (v_[k] * v_[k] - change * change);
      energy.stored += 0.5 * u_[k] * pull[k];
    }
    return energy;
  }
  Values momentum() override {
    Values all(2, 0.0);
    for (std::size_t k = 0; k < v_.size(); ++k) all[k % 2] += masses_[k / 2] * v_[k];
    return all;
  }

  abut::Grid grid() override {
    abut::Grid grid{points_, {}};
    for (const auto& cell : cells_) grid.cells.push_back({9, {cell.begin(), cell.end()}});
    return grid;  // 9: VTK's quadrilateral
  }
  abut::Fields node_fields() override {
    return {{"displacement", in_space(u_)}, {"velocity", in_space(v_)}};
  }

 private:
  static std::size_t at(int place) { return static_cast<std::size_t>(place); }
  static int whole(const abut::Keys& keys, std::size_t axis) {
    const double count = keys.numbers("cells", 2)[axis];
    if (count < 1.0 || count != std::floor(count))
      keys.refuse("cells", "must be whole numbers above 0", "Give two.");
    return static_cast<int>(count);
  }
  int node(int i, int j) const { return i * (ny_ + 1) + j; }

  void make_mesh(const Values& corner) {
    for (int i = 0; i <= nx_; ++i)
      for (int j = 0; j <= ny_; ++j) {
        points_.push_back(corner[0] + i * lengths_[0] / nx_);
        points_.push_back(corner[1] + j * lengths_[1] / ny_);
      }
    for (int i = 0; i < nx_; ++i)
      for (int j = 0; j < ny_; ++j)
        cells_.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  }

  /// Stiffness of a cell: strains at four points, by the law of plane strain.
  void make_cell(double modulus, double ratio, double density) {
    const double lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio));
    const double shear = modulus / (2 * (1 + ratio)), gauss = 1.0 / std::sqrt(3.0);
    const double law[3][3] = {
        {lame + 2 * shear, lame, 0}, {lame, lame + 2 * shear, 0}, {0, 0, shear}};
    const double sx[4] = {-1, 1, 1, -1}, sy[4] = {-1, -1, 1, 1};
    const double hx = lengths_[0] / nx_, hy = lengths_[1] / ny_;
    transit_ = std::abs(hx) / std::sqrt((lame + 2 * shear) / density);
    for (const double x : {-gauss, gauss})
      for (const double y : {-gauss, gauss}) {
        double strain[3][8] = {};
        for (int n = 0; n < 4; ++n) {
          const double dx = sx[n] * (1 + sy[n] * y) / (2 * hx),
                       dy = sy[n] * (1 + sx[n] * x) / (2 * hy);
          strain[0][2 * n] = strain[2][2 * n + 1] = dx;
          strain[1][2 * n + 1] = strain[2][2 * n] = dy;
        }
        for (int r = 0; r < 8; ++r)
          for (int c = 0; c < 8; ++c)
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j)
                cell_[r][c] += strain[i][r] * law[i][j] * strain[j][c] * hx * hy / 4;
      }
  }

  /// [N/m] of the springs, against displacements.
  Values pulled() const {
    Values f(u_.size(), 0.0);
    for (const auto& cell : cells_)
      for (std::size_t r = 0; r < 8; ++r)
        for (std::size_t c = 0; c < 8; ++c)
          f[2 * at(cell[r / 2]) + r % 2] += cell_[r][c] * u_[2 * at(cell[c / 2]) + c % 2];
    return f;
  }

  void kick(double dt, const Values& force) {
    Values f = pulled();
    for (double& each : f) each = -each;
    for (int k = 0; k <= ny_; ++k)
      for (std::size_t i = 0; i < 2; ++i) f[2 * at(node(0, ny_ - k)) + i] += force[2 * at(k) + i];
    for (std::size_t k = 0; k < v_.size(); ++k) v_[k] += dt * f[k] / masses_[k / 2];
  }

  Values of_face(const Values& all) const {
    Values values;
    for (int k = 0; k <= ny_; ++k)
      for (std::size_t i = 0; i < 2; ++i) values.push_back(all[2 * at(node(0, ny_ - k)) + i]);
    return values;
  }
  static Values in_space(const Values& plane) {
    Values values;
    for (std::size_t k = 0; k < plane.size(); k += 2)
      values.insert(values.end(), {plane[k], plane[k + 1], 0.0});
    return values;
  }

  int nx_, ny_;
  Values lengths_, points_, masses_;       // [m] [m] (nodes, 2), [kg/m] (nodes)
  std::vector<std::array<int, 4>> cells_;  // nodes, counterclockwise
  double cell_[8][8] = {};                 // [N/m^2]
  double transit_ = 0.0;                   // [s] in which the fastest wave crosses a cell
  Values u_, v_;                           // [m] [m/s] (nodes, 2)
};

int main(int argc, char** argv) { return abut::serve<Plate>(argc, argv); }
