#pragma once
/// Sums of products as if in twice the precision, for the residuals of iterative refinement.
/// Ogita, Rump and Oishi, "Accurate sum and dot product", SIAM J. Sci. Comput. 26, 2005 (doi:10.1137/030601818),
/// algorithm 5.3 (Dot2).

#include <cmath>

namespace gonio {

/// A sum of products that also accumulates the rounding errors of its terms.
class compensated_sum {
 public:
  explicit compensated_sum(double start = 0.0) noexcept : sum_(start) {}

  void add_product(double a, double b) noexcept {
    const double product = a * b;
    add(product);
    lost_ += std::fma(a, b, -product);
  }
  void add(double value) noexcept {
    const double next = sum_ + value, part = next - sum_;
    lost_ += (sum_ - (next - part)) + (value - part);
    sum_ = next;
  }
  [[nodiscard]] double value() const noexcept { return sum_ + lost_; }

 private:
  double sum_;
  double lost_ = 0.0;
};

}  // namespace gonio
