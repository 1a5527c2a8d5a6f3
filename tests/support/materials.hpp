#pragma once

#include <cmath>
#include <memory>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "base/index.hpp"
#include "subdomain_solver/materials/hencky.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"

namespace abut {

/// A law under test. Moduli of order 1, so that tolerances read as relative ones.
struct Law {
  std::string name;
  std::shared_ptr<const Material> law;  // shared: GoogleTest copies its parameters
  bool objective = true;
};

/// What GoogleTest prints for the parameter.
inline void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }

/// The law of a test case inside another law; the case keeps its own.
class Borrowed final : public Material {
 public:
  explicit Borrowed(const Material& law) : law_(law) {}
  double density() const override { return law_.density(); }
  Moduli moduli() const override { return law_.moduli(); }
  bool is_linear() const override { return law_.is_linear(); }
  int history_size() const override { return law_.history_size(); }
  bool evaluate(const Matrix3& f, std::span<const double> before, std::span<double> after,
                Need want, PointResponse& out) const override {
    return law_.evaluate(f, before, after, want, out);
  }

 private:
  const Material& law_;
};

inline const Moduli test_moduli{1.25, 0.5};

/// Yields at a strain of 2 %; both parts of the hardening act.
inline Hardening test_hardening() {
  Hardening h;
  h.yield_stress = 0.03;
  h.modulus = 0.05;
  h.saturation = Saturation{0.045, 8.0};
  return h;
}

inline std::vector<Law> all_laws() {
  const MooneyRivlinParameters rubber{0.15, 0.1, test_moduli.bulk, 1.0};
  const Moduli& m = test_moduli;
  return {{"linear_elastic", std::make_shared<LinearElastic>(m, 1.0), false},
          {"saint_venant_kirchhoff", std::make_shared<SaintVenantKirchhoff>(m, 1.0)},
          {"neo_hookean", std::make_shared<NeoHookean>(m, 1.0)},
          {"mooney_rivlin", std::make_shared<MooneyRivlin>(rubber)},
          {"hencky", std::make_shared<Hencky>(m, 1.0)},
          {"j2_plasticity", std::make_shared<J2Plasticity>(m, test_hardening(), 1.0)}};
}

/// Random numbers that are the same in every run and on every platform.
class DrawTensors {
 public:
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  Matrix3 matrix(double size) {
    return Matrix3::NullaryExpr([this, size] { return between(-size, size); });
  }
  Matrix3 rotation() {
    const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([this] { return between(-1.0, 1.0); });
    return Eigen::Quaterniond(q).normalized().toRotationMatrix();
  }

 private:
  std::mt19937_64 engine_{20};
};

/// Deformation gradients at which laws are differentiated: the reference, small strains, large
/// stretches in rotated axes, two and three equal or nearly equal stretches.
inline std::vector<Matrix3> sample_deformations() {
  DrawTensors draw;
  std::vector<Matrix3> samples = {Matrix3::Identity(), 1.2 * Matrix3::Identity()};
  for (const double size : {1.0e-8, 1.0e-3, 5.0e-3})
    samples.push_back(Matrix3::Identity() + draw.matrix(size));
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d stretch =
        Eigen::Vector3d::NullaryExpr([&draw] { return draw.between(0.7, 1.6); });
    samples.push_back(draw.rotation() * stretch.asDiagonal() * draw.rotation());
  }
  for (const double apart : {0.0, 1.0e-12, 1.0e-8, 1.0e-5}) {
    const Eigen::Vector3d stretch(1.3, 1.3 + apart, 0.8);
    samples.push_back(draw.rotation() * stretch.asDiagonal() * draw.rotation());
    samples.push_back(draw.rotation() *
                      Eigen::Vector3d(1.1, 1.1 + apart, 1.1 - apart).asDiagonal());
  }
  return samples;
}

using History = std::vector<double>;

inline History zero_history(const Material& law) { return History(index(law.history_size()), 0.0); }

/// Answer from a given history; the history at the end takes its place when `advance`.
inline PointResponse answer(const Material& law, const Matrix3& f, History& history,
                            bool advance = false, Need want = Need::tangent) {
  PointResponse out;
  History after(history.size());
  if (!law.evaluate(f, history, after, want, out))
    throw std::runtime_error("the law has no answer at an admissible deformation");
  if (advance) history = after;
  return out;
}

}  // namespace abut
