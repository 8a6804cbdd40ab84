#pragma once
/// Interpolation between nearest samples. Without nanoflann, `interpolate` throws gonio::error.

#include <gonio/core/brdf.hpp>
#include <gonio/interpolate/scattered_options.hpp>
#include <gonio/table/sample_set.hpp>

#include <functional>

namespace cli {

/// A `gonio::scattered_brdf` behind a type-erased function.
struct interpolated_samples {
  std::function<gonio::rgb(const gonio::direction& wi, const gonio::direction& wo)> value;

  [[nodiscard]] gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return value(wi, wo);
  }
};

static_assert(gonio::brdf<interpolated_samples>);

[[nodiscard]] interpolated_samples interpolate(const gonio::sample_set& samples,
                                               const gonio::scattered_options& options);

}  // namespace cli
