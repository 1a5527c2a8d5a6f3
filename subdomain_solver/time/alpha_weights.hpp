#pragma once

namespace abut {

/// Weights of the generalised-alpha family (Chung and Hulbert 1993):
///   (1 - am) M a(n+1) + am M a(n) + (1 - af) (r(n+1) - f(n+1)) + af (r(n) - f(n)) = 0
/// with Newmark's beta and gamma. am = af = 0 is Newmark, am = 0 is HHT-alpha.
struct AlphaWeights {
  double alpha_m = 0.0, alpha_f = 0.0, beta = 0.25, gamma = 0.5;

  bool is_newmark() const { return alpha_m == 0.0 && alpha_f == 0.0; }
  bool is_trapezoidal() const { return is_newmark() && beta == 0.25 && gamma == 0.5; }

  static AlphaWeights newmark(double beta, double gamma) { return {0.0, 0.0, beta, gamma}; }
  /// alpha in [-1/3, 0]
  static AlphaWeights hht(double alpha) {
    return {0.0, -alpha, 0.25 * (1.0 - alpha) * (1.0 - alpha), 0.5 - alpha};
  }
  /// Spectral radius at infinite frequency, in [0, 1].
  static AlphaWeights spectral_radius(double rho) {
    const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
    const double alpha_f = rho / (rho + 1.0);
    const double shift = 1.0 - alpha_m + alpha_f;
    return {alpha_m, alpha_f, 0.25 * shift * shift, 0.5 - alpha_m + alpha_f};
  }
};

}  // namespace abut
