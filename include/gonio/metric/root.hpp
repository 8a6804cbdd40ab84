#pragma once
/// The p-th root of reflectance. The default square root is epsilon_root(x) = sqrt(x) of Noell, Koehler and Stricker
/// 2014, section 3.1 (in the text on Table 2).

#include <gonio/core/error.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/metric/location_free.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace gonio {

/// forward(rho) = rho^(1/p), continued to negative reflectance as an odd function, -(-rho)^(1/p): negative measurements
/// stay negative. The slope at zero is infinite (p > 1): noise around zero has a large effect.
class root : public location_free_metric<root> {
 public:
  /// Throws gonio::error unless p is finite and at least 1.
  explicit root(double p = 2.0);

  [[nodiscard]] double p() const noexcept { return p_; }

  [[nodiscard]] double map(double rho) const noexcept {
    const double size = std::abs(rho);
    return std::copysign(p_ == 2.0 ? std::sqrt(size) : std::pow(size, 1.0 / p_), rho);
  }
  [[nodiscard]] double unmap(double y) const noexcept {
    const double size = std::abs(y);
    return std::copysign(p_ == 2.0 ? size * size : std::pow(size, p_), y);
  }
  /// Returns the derivative of `map`. It is infinite at zero for p > 1: below 1e-12, returns the derivative at 1e-12.
  [[nodiscard]] double slope(double rho) const noexcept {
    const double size = std::max(std::abs(rho), 1e-12);
    return std::pow(size, 1.0 / p_ - 1.0) / p_;
  }
  void unmap_all(std::span<float> values) const {
    const auto p = static_cast<float>(p_);
    if (p_ == 2.0)
      map_by_sixteens(values.data(), std::ssize(values), [](auto& these) { these *= these.abs(); });
    else
      map_by_sixteens(values.data(), std::ssize(values), [&](auto& these) { these = these.max(0.0f).pow(p); });
  }

 private:
  double p_;
};

static_assert(row_metric<root> && smooth_metric<root>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/metric/impl/root.ipp>
#endif
