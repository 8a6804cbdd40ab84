#pragma once
/// A prior for soft and one for specular materials, of which the measurements choose.
/// Nielsen, Jensen and Ramamoorthi 2015 (doi:10.1145/2816795.2818085), section 8: whether a material is specular is
/// told by the ratio of an in-peak to an out-of-peak sample; what ratio exactly says estimate/highlight_contrast.hpp.

#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/highlight_contrast.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace gonio {

/// What a material is taken for.
enum class material_kind { soft, specular };

/// The fit of the one estimator or the other.
template <tabulated_brdf Soft, tabulated_brdf Specular>
class soft_or_specular_fit {
 public:
  /// `contrast` is what it was chosen by.
  soft_or_specular_fit(std::variant<Soft, Specular> fit, double contrast) : fit_(std::move(fit)), contrast_(contrast) {}

  [[nodiscard]] material_kind kind() const noexcept {
    return fit_.index() == 0 ? material_kind::soft : material_kind::specular;
  }
  /// The measured contrast; see `highlight_contrast`.
  [[nodiscard]] double contrast() const noexcept { return contrast_; }
  /// The fit itself, soft at index 0 and specular at 1.
  [[nodiscard]] const std::variant<Soft, Specular>& chosen() const noexcept { return fit_; }

  /// Reflectance in sr^-1, at least zero; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (const auto* soft = std::get_if<0>(&fit_)) return (*soft)(wi, wo);
    return (*std::get_if<1>(&fit_))(wi, wo);
  }

  /// Same bytes for any number of threads.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    return std::visit([&](const auto& fit) { return fit.tabulate(cells, threads); }, fit_);
  }

 private:
  std::variant<Soft, Specular> fit_;
  double contrast_;
};

/// Fits by the first estimator measurements whose contrast is below the threshold, by the second the others. Both are
/// any estimators; the paper's are decompositions by the principal components of either half of a database.
///
/// Measurements none of which is in the peak, or none out of it, do not tell soft from specular, and are refused: a
/// prior chosen by anything else would be a guess, and the one prior of all materials is the better one then. Ask
/// `highlight_contrast` beforehand where that may happen. Of the directions of the paper's Table 1 only the set of one
/// is such.
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
  /// `reference` and `regions` are those that the threshold was found with. Throws gonio::error unless the threshold is
  /// finite and the regions follow one another.
  soft_or_specular(Soft soft, Specular specular, log_relative reference, double threshold,
                   highlight_regions regions = {})
      : soft_(std::move(soft)),
        specular_(std::move(specular)),
        reference_(std::move(reference)),
        threshold_(threshold),
        regions_(regions) {
    if (!std::isfinite(threshold)) refuse("the contrast between soft and specular materials must be finite");
    if (!(regions.in_peak >= 0.0 && regions.in_peak < regions.off_peak))
      refuse("the highlight (theta_h up to " + in_degrees(regions.in_peak) +
             ") must end before what is out of it begins (" + in_degrees(regions.off_peak) + ")");
  }

  [[nodiscard]] const Soft& soft() const noexcept { return soft_; }
  [[nodiscard]] const Specular& specular() const noexcept { return specular_; }
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

  /// The contrast of measurements. Throws gonio::error for unusable ones, or if none is in the peak or none out of it.
  template <sample_range Samples>
  [[nodiscard]] double contrast(const Samples& samples) const {
    if (const auto found = highlight_contrast(reference_, samples, regions_)) return *found;
    refuse("the samples do not tell soft from specular: one with theta_h up to " + in_degrees(regions_.in_peak) +
           " and one from " + in_degrees(regions_.off_peak) + " on are needed");
  }

  /// What the material is taken for. Throws gonio::error as `contrast` does.
  template <sample_range Samples>
  [[nodiscard]] material_kind choose(const Samples& samples) const {
    return kind_of(contrast(samples));
  }

  /// Costs what the chosen fit costs. Throws gonio::error as `contrast` and the chosen estimator do.
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
