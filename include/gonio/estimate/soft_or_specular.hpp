#pragma once
/// Two priors, one for soft and one for specular materials; the measurements decide which to use. Nielsen, Jensen and
/// Ramamoorthi 2015 (doi:10.1145/2816795.2818085), section 8, decide whether a material is specular by the ratio of an
/// in-peak to an out-of-peak sample. estimate/highlight_contrast.hpp defines the ratio.

#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/highlight_contrast.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace gonio {

/// The kind of material that a prior was learned from.
enum class material_kind { soft, specular };

/// A fit by one of two estimators.
template <tabulated_brdf Soft, tabulated_brdf Specular>
class soft_or_specular_fit {
 public:
  /// `contrast` is the contrast that decided the choice.
  soft_or_specular_fit(std::variant<Soft, Specular> fit, double contrast) : fit_(std::move(fit)), contrast_(contrast) {}

  [[nodiscard]] material_kind kind() const noexcept {
    return fit_.index() == 0 ? material_kind::soft : material_kind::specular;
  }
  /// Returns the measured contrast; see `highlight_contrast`.
  [[nodiscard]] double contrast() const noexcept { return contrast_; }
  /// Returns the fit of the chosen estimator: soft at index 0, specular at index 1.
  [[nodiscard]] const std::variant<Soft, Specular>& chosen() const noexcept { return fit_; }

  /// Returns the reflectance in sr^-1, at least zero; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (const auto* soft = std::get_if<0>(&fit_)) return (*soft)(wi, wo);
    return (*std::get_if<1>(&fit_))(wi, wo);
  }

  /// Tabulates the fit. Any number of threads gives the same bytes.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    return std::visit([&](const auto& fit) { return fit.tabulate(cells, threads); }, fit_);
  }

 private:
  std::variant<Soft, Specular> fit_;
  double contrast_;
};

/// Fits measurements by the estimator `Soft` if their contrast is below the threshold, otherwise by `Specular`. Both
/// can be any estimators. The paper uses decompositions by the principal components of the soft and of the specular
/// materials of a database.
///
/// Distinguishing soft from specular materials takes a sample in the peak and a sample out of the peak. Throws
/// gonio::error for measurements that lack either, for which `highlight_contrast` returns nothing; use a single prior
/// of all materials for these. Of the sets of directions in the paper's Table 1, only the set of one direction lacks
/// one of the two.
///
/// ```cpp
/// const auto reference = gonio::log_relative::to_median_of(materials);
/// const auto halves = gonio::split_by_contrast(materials, reference);
/// const gonio::soft_or_specular estimator{
///     gonio::decomposition{gonio::learn_pca(halves.soft, reference, 60), gonio::tikhonov{20.0}},
///     gonio::decomposition{gonio::learn_pca(halves.specular, reference, 60), gonio::tikhonov{20.0}},
///     reference, halves.threshold};
/// ```
template <estimator Soft, estimator Specular>
class soft_or_specular {
 public:
  /// `reference` and `regions` must be those with which the threshold was found. Throws gonio::error unless the
  /// threshold is finite and the region of the peak ends before the region outside of it begins.
  soft_or_specular(Soft soft, Specular specular, log_relative reference, double threshold,
                   highlight_regions regions = {})
      : soft_(std::move(soft)),
        specular_(std::move(specular)),
        reference_(std::move(reference)),
        threshold_(threshold),
        regions_(regions) {
    if (!std::isfinite(threshold)) refuse("the contrast threshold between soft and specular materials must be finite");
    if (!(regions.in_peak >= 0.0 && regions.in_peak < regions.off_peak))
      refuse("the highlight (theta_h up to " + in_degrees(regions.in_peak) +
             ") must end before the region outside it begins (" + in_degrees(regions.off_peak) + ")");
  }

  [[nodiscard]] const Soft& soft() const noexcept { return soft_; }
  [[nodiscard]] const Specular& specular() const noexcept { return specular_; }
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

  /// Returns the contrast of measurements. Throws gonio::error if they are unusable, if none is in the peak, or if none
  /// is out of the peak.
  template <sample_range Samples>
  [[nodiscard]] double contrast(const Samples& samples) const {
    if (const auto found = highlight_contrast(reference_, samples, regions_)) return *found;
    refuse("the choice of soft or specular needs a sample with theta_h up to " + in_degrees(regions_.in_peak) +
           " and one with theta_h of at least " + in_degrees(regions_.off_peak));
  }

  /// Returns the kind of the material. Throws gonio::error as `contrast` does.
  template <sample_range Samples>
  [[nodiscard]] material_kind choose(const Samples& samples) const {
    return kind_of(contrast(samples));
  }

  /// Fits by the estimator that `choose` selects. Throws gonio::error as `contrast` and that estimator's `fit` do.
  template <sample_range Samples>
  [[nodiscard]] auto fit(const Samples& samples) const {
    using soft_fit = std::remove_cvref_t<decltype(soft_.fit(samples))>;
    using specular_fit = std::remove_cvref_t<decltype(specular_.fit(samples))>;
    using either = std::variant<soft_fit, specular_fit>;
    const double found = contrast(samples);
    if (kind_of(found) == material_kind::soft)
      return soft_or_specular_fit<soft_fit, specular_fit>(either(std::in_place_index<0>, soft_.fit(samples)), found);
    return soft_or_specular_fit<soft_fit, specular_fit>(either(std::in_place_index<1>, specular_.fit(samples)), found);
  }

 private:
  [[nodiscard]] material_kind kind_of(double contrast) const noexcept {
    return contrast < threshold_ ? material_kind::soft : material_kind::specular;
  }

  [[nodiscard]] static std::string in_degrees(double angle) { return std::to_string(degrees(angle)) + " degrees"; }

  Soft soft_;
  Specular specular_;
  log_relative reference_;
  double threshold_;
  highlight_regions regions_;
};

}  // namespace gonio
