#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include <Eigen/Dense>

#include "base/archive.hpp"

namespace abut {

/// Multiplies a residual by something that stands for the inverse Jacobian.
using ApplyInverse = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// What an island knows of its inverse Jacobian in a window.
struct Inverses {
  ApplyInverse kernels;  // by the port kernels of the bodies
  ApplyInverse relaxed;  // one number per joint, by impedance probe
};

/// What an accelerator takes in place of the inverse Jacobian.
class Preconditioner {
 public:
  static Preconditioner kernels() { return {Kind::kernels, 1.0}; }
  static Preconditioner relaxed() { return {Kind::relaxed, 1.0}; }
  static Preconditioner number(double factor) { return {Kind::number, factor}; }

  Eigen::VectorXd apply(const Eigen::VectorXd& r, const Inverses& inverses) const {
    if (kind_ == Kind::number) return factor_ * r;
    return kind_ == Kind::kernels ? inverses.kernels(r) : inverses.relaxed(r);
  }

 private:
  enum class Kind { kernels, relaxed, number };
  Preconditioner(Kind kind, double factor) : kind_(kind), factor_(factor) {}
  Kind kind_;
  double factor_;
};

/// Chooses the next iterate from the last one and its image. Sees one stacked vector for the whole
/// window: every trace of every exchanged field, in units of its own.
class Accelerator {
 public:
  virtual ~Accelerator() = default;
  /// 1 / unit of every entry, by which residuals are compared; without them all are 1. They may
  /// change from iterate to iterate: what is kept has no part in them.
  void weigh(const Eigen::VectorXd& weights) { weights_ = weights; }
  /// Starts a window; `key` identifies the layout of its vectors: memory of another layout is not
  /// used.
  virtual void reset(std::uint64_t key) = 0;
  /// x_k, G(x_k) -> x_{k+1}
  virtual Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                               const Inverses& inverses) = 0;
  /// In this window the inverse alone is not enough: what earlier ones have learned counts at once.
  virtual void doubt() = 0;
  /// What was learned led away from the solution: it holds no longer.
  virtual void forget() = 0;
  /// The window was accepted: what was learned in it may serve the next one.
  virtual void accept() = 0;
  /// What it carries from window to window.
  virtual void state(Archive& archive) = 0;

 protected:
  Eigen::VectorXd weighted(const Eigen::VectorXd& r) const {
    return weights_.size() == r.size() ? Eigen::VectorXd(r.cwiseProduct(weights_)) : r;
  }

 private:
  Eigen::VectorXd weights_;
};

/// An accelerator that carries nothing from window to window.
class Forgetful : public Accelerator {
 public:
  void doubt() override {}
  void forget() override {}
  void accept() override {}
  void state(Archive&) override {}
};

/// x_{k+1} = x_k + P (G - x_k); with P = 1 it is the plain iteration.
class Relaxation final : public Forgetful {
 public:
  explicit Relaxation(Preconditioner by) : by_(by) {}
  void reset(std::uint64_t) override {}
  Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                       const Inverses& inverses) override;

 private:
  Preconditioner by_;
};

/// Aitken's dynamic relaxation of P (G - x), |factor| limited to 2.
class Aitken final : public Forgetful {
 public:
  explicit Aitken(Preconditioner by, double initial = 1.0)
      : by_(by), initial_(initial), factor_(initial) {}
  void reset(std::uint64_t) override;
  Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                       const Inverses& inverses) override;

 private:
  Preconditioner by_;
  double initial_;
  double factor_;
  Eigen::VectorXd previous_;  // residual
};

/// Quasi-Newton with secants of this and the last `reuse` windows and an approximate inverse of the
/// Jacobian J = -d(G - x)/dx for what they leave open  [M.11]:
///   a = argmin |S (r + V a)|,   x += (W - V) a + J^-1 (r + V a),   S the weights
/// With J^-1 a number it is IQN-ILS (Anderson acceleration); with the port kernels' Jacobian it is
/// the kernel method, where secants of earlier windows are used only once the Jacobian alone has
/// proved not to be enough.
class QuasiNewton final : public Accelerator {
 public:
  /// `exact_enough`: number of iterations up to which the inverse alone is trusted; 0: secants
  /// always.
  QuasiNewton(Preconditioner inverse, int reuse, double filter, int exact_enough);
  void reset(std::uint64_t key) override;
  Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                       const Inverses& inverses) override;
  void doubt() override { needed_ = true; }
  void forget() override;
  void accept() override;
  void state(Archive& archive) override;

 private:
  struct Secant {
    Eigen::VectorXd residual, image;  // differences
  };
  struct Selection {
    Eigen::MatrixXd weighted, residuals, images;  // residuals twice: as weighed, and as they are
  };
  Selection select() const;

  Preconditioner inverse_;
  int reuse_;
  double filter_;
  int exact_enough_;
  bool needed_ = false;  // the last window was not finished by the inverse alone
  std::uint64_t key_ = 0;
  int updates_ = 0;
  std::deque<Secant> current_;              // newest first
  std::deque<std::deque<Secant>> earlier_;  // newest window first
  Eigen::VectorXd previous_residual_, previous_image_;
};

}  // namespace abut
