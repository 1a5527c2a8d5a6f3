#include "subdomain_solver/solve/tridiagonal.hpp"

namespace abut {

void TriDiagonal::factor(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const std::size_t n = diagonal.size();
  lower_.assign(n, 0.0);
  inverse_pivot_.assign(n, 0.0);
  inverse_pivot_[0] = 1.0 / diagonal[0];
  for (std::size_t i = 1; i < n; ++i) {
    lower_[i] = beside[i - 1] * inverse_pivot_[i - 1];
    inverse_pivot_[i] = 1.0 / (diagonal[i] - lower_[i] * beside[i - 1]);
  }
}

void TriDiagonal::solve(std::vector<double>& x) const {
  const std::size_t n = x.size();
  for (std::size_t i = 1; i < n; ++i) x[i] -= lower_[i] * x[i - 1];
  x[n - 1] *= inverse_pivot_[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) x[i] = x[i] * inverse_pivot_[i] - lower_[i + 1] * x[i + 1];
}

}  // namespace abut
