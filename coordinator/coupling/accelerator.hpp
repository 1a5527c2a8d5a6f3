#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include <Eigen/Dense>

namespace abut {

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
  virtual Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image) = 0;
  /// In this window the inverse alone is not enough: what earlier ones have learned counts at once.
  virtual void doubt() {}
  /// What was learned led away from the solution: it holds no longer.
  virtual void forget() {}
  /// The window was accepted: what was learned in it may serve the next one.
  virtual void accept() {}

 protected:
  Eigen::VectorXd weighted(const Eigen::VectorXd& r) const {
    return weights_.size() == r.size() ? Eigen::VectorXd(r.cwiseProduct(weights_)) : r;
  }

 private:
  Eigen::VectorXd weights_;
};

/// Multiplies a residual by something that stands for the inverse Jacobian: a matrix, or one number
/// per interface.
using ApplyInverse = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// x_{k+1} = x_k + factor (G - x_k); factor 1 is the plain iteration.
class Relaxation final : public Accelerator {
 public:
  explicit Relaxation(double factor) : factor_(factor) {}
  explicit Relaxation(ApplyInverse probe) : factor_(1.0), probe_(std::move(probe)) {}
  void reset(std::uint64_t) override {}
  Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image) override;

 private:
  double factor_;
  ApplyInverse probe_;  // empty: 1
};

/// Aitken's dynamic relaxation, |factor| limited to 2. With a probe it relaxes the probed residual.
class Aitken final : public Accelerator {
 public:
  explicit Aitken(double initial) : initial_(initial) {}
  explicit Aitken(ApplyInverse probe, double initial = 1.0)
      : initial_(initial), probe_(std::move(probe)) {}
  void reset(std::uint64_t) override;
  Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image) override;

 private:
  double initial_;
  ApplyInverse probe_;  // empty: 1
  double factor_ = 0.0;
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
  using Inverse = ApplyInverse;

  /// `exact_enough`: number of iterations up to which the inverse alone is trusted; 0: secants
  /// always.
  QuasiNewton(Inverse inverse, int reuse, double filter, int exact_enough);
  void reset(std::uint64_t key) override;
  Eigen::VectorXd next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image) override;
  void doubt() override { needed_ = true; }
  void forget() override;
  void accept() override;

 private:
  struct Secant {
    Eigen::VectorXd residual, image;  // differences
  };
  struct Selection {
    Eigen::MatrixXd weighted, residuals, images;  // residuals twice: as weighed, and as they are
  };
  Selection select() const;

  Inverse inverse_;
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
