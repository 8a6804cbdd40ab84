#pragma once
/// Bodies of model/sufficient_wavelengths.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/model/sufficient_wavelengths.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace gonio::model::detail {

/// Finds how far a straight line from one wavelength stays close to many spectra.
class straight_reach {
 public:
  /// Starts at the wavelength `first` and looks no farther than the wavelength `last`.
  straight_reach(const std::vector<double>& wavelengths, Eigen::Index first, Eigen::Index last)
      : at_(wavelengths), first_(first), last_(last), is_bent_(wavelengths.size(), false) {}

  /// Shortens the reach to the wavelengths up to which a line can stay within `allowed(i)` of a spectrum's values.
  template <class Values, class Allowed>
  void shorten_to(const Values& values, const Allowed& allowed) {
    double least = -std::numeric_limits<double>::infinity(),
           most = -least;  // smallest and largest slope of the lines that are still possible
    for (Eigen::Index i = first_ + 1; i <= last_; ++i) {
      const double run = at_[i] - at_[first_], rise = double{values[i]} - double{values[first_]};
      if (rise < least * run || rise > most * run) is_bent_[i] = true;
      least = std::max(least, (rise - allowed(i)) / run);
      most = std::min(most, (rise + allowed(i)) / run);
      if (least > most) last_ = i;
    }
  }

  /// Returns the farthest wavelength that a line can reach. The wavelength after the first is always possible.
  [[nodiscard]] Eigen::Index farthest() const {
    Eigen::Index i = last_;
    while (is_bent_[i]) --i;
    return i;
  }

 private:
  const std::vector<double>& at_;
  Eigen::Index first_, last_;
  std::vector<bool> is_bent_;
};

/// The spectra of a table, and the tolerances for them.
class spectra_within {
 public:
  spectra_within(const spectral_table& table, double tolerance, thread_count threads)
      : table_(table),
        tolerance_(tolerance),
        albedos_(Eigen::ArrayXXd::Zero(table.bands(), 5)),
        inverse_cosines_(table.cells().size()) {
    constexpr int bins = 100;
    const auto add_albedo = [&](Eigen::Index k) {
      for_each_light(radians(20.0 * static_cast<double>(k)), bins,
                     [&](const direction& wi, const direction& wo, double weight) {
                       albedos_.col(k) += weight * table_(wi, wo).cast<double>();
                     });
    };
    for_each_index(albedos_.cols(), 1, add_albedo, threads);
    for (Eigen::Index cell = 0; cell < inverse_cosines_.size(); ++cell) {
      const cosine_pair cosine = cosines(table_.cells().angles(cell));
      inverse_cosines_[cell] = 1.0 / std::max(cosine.i * cosine.o, 1e-6);
    }
  }

  /// Returns the farthest wavelength, at most `last`, such that a straight line from `first` stays within the tolerance
  /// of all spectra.
  [[nodiscard]] Eigen::Index straight_until(Eigen::Index first, Eigen::Index last) const {
    straight_reach reach(table_.wavelengths(), first, last);
    for (Eigen::Index k = 0; k < albedos_.cols(); ++k)
      reach.shorten_to(albedos_.col(k), [&](Eigen::Index i) { return tolerance_ * std::abs(albedos_(i, k)); });
    for (Eigen::Index cell = 0; cell < inverse_cosines_.size(); ++cell) {
      const auto values = table_.at(cell);
      const double dark = dark_share * std::numbers::inv_pi * inverse_cosines_[cell];
      reach.shorten_to(values, [&](Eigen::Index i) {
        return tolerance_ * std::max(std::abs(double{values[i]}), dark * std::abs(albedos_(i, 0)));
      });
    }
    return reach.farthest();
  }

 private:
  /// The tolerance is relative to a value or, if that is larger, to this share of a diffuser with the material's
  /// albedo.
  static constexpr double dark_share = 0.1;

  const spectral_table& table_;
  double tolerance_;
  Eigen::ArrayXXd albedos_;         ///< wavelengths x angles
  Eigen::ArrayXd inverse_cosines_;  ///< one over the product of the cosines of light and viewer, for each cell
};

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE std::vector<Eigen::Index> sufficient_wavelengths(const spectral_table& table, double tolerance,
                                                              thread_count threads) {
  if (!(tolerance >= 0.0)) refuse("the tolerance of wavelengths must be at least 0, not " + std::to_string(tolerance));
  std::vector<Eigen::Index> chosen{0};
  if (tolerance == 0.0) {
    chosen.resize(table.wavelengths().size());
    std::iota(chosen.begin(), chosen.end(), Eigen::Index{0});
    return chosen;
  }
  const detail::spectra_within spectra(table, tolerance, threads);
  const auto is_seen = [&](Eigen::Index band) { return is_visible(table.wavelengths()[band]); };
  for (Eigen::Index last = 1; last < table.bands(); ++last) {
    const bool is_end = last == table.bands() - 1 || (is_seen(last) && !(is_seen(last - 1) && is_seen(last + 1)));
    while (is_end && chosen.back() < last) chosen.push_back(spectra.straight_until(chosen.back(), last));
  }
  return chosen;
}

}  // namespace gonio::model
