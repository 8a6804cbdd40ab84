#pragma once
/// Scattered measurements as a BRDF, without a prior: the value of the nearest measurement, or the mean of the k
/// nearest measurements weighted by inverse distance. D. Shepard, "A two-dimensional interpolation function for
/// irregularly-spaced data", ACM 1968 (doi:10.1145/800186.810616), with weights that vanish at the next neighbour: R.
/// Franke and G. Nielson, "Smooth interpolation of large sets of scattered data", 1980 (doi:10.1002/nme.1620151110).
/// Needs gonio::scattered (nanoflann).
///
/// ```cpp
/// const auto paint = gonio::scattered_interpolation{}.fit(gonio::io::read_cornell("garnet_red.brdf"));
/// ```

#include <gonio/core/parallel.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/interpolate/scattered_options.hpp>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

namespace gonio {

/// The fit of `scattered_interpolation`. Copies share the samples.
class scattered_brdf {
 public:
  /// Returns the reflectance in sr^-1, at least zero; zero below the horizon. It is the mean of the k nearest samples,
  /// in the domain of the options. With their distances d_i, their own weights w_i, and the distance R of the next
  /// sample, sample i has the weight w_i ((R - d_i) / (R d_i))^p. The result is continuous, and equals a sample's value
  /// in the sample's own directions. Exactly reciprocal; isotropic except for rounding, which chooses the neighbours if
  /// more than k are equally near. O(k log n).
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept;

  /// Tabulates the fit at the cells of a grid. Any number of threads gives the same bytes.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    return gonio::tabulate(*this, cells, threads);
  }

 private:
  friend class scattered_interpolation;
  struct embedded_samples;

  explicit scattered_brdf(const scattered_options& options) : options_(options) {}

  [[nodiscard]] rgb mean_of_neighbours(const embedded_samples& of, const std::array<double, 4>& at) const noexcept;

  scattered_options options_;
  /// A single set for all channels, or one for each channel if weights differ between channels.
  std::vector<std::shared_ptr<const embedded_samples>> channels_;
};

static_assert(tabulated_brdf<scattered_brdf>);

/// Interpolates measurements without a prior. The result has the resolution of the measurements, and no highlight that
/// was not measured.
class scattered_interpolation {
 public:
  /// Throws gonio::error for options out of their range.
  explicit scattered_interpolation(const scattered_options& options = {}) : options_(options) {
    require_usable(options);
  }

  [[nodiscard]] const scattered_options& options() const noexcept { return options_; }

  /// Fits samples. O(n log n). Measurements of the same angles are merged into their weighted mean. Throws gonio::error
  /// for unusable samples (`require_usable`), and if all weights are zero in one of the channels.
  [[nodiscard]] scattered_brdf fit(const sample_set& samples) const;

  template <sample_range Samples>
  [[nodiscard]] scattered_brdf fit(const Samples& samples) const {
    sample_set all;
    for (const sample& s : samples) all.push_back(s);
    return fit(all);
  }

 private:
  scattered_options options_;
};

static_assert(estimator<scattered_interpolation>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/interpolate/impl/scattered_brdf.ipp>
#endif
