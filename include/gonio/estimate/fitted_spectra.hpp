#pragma once
/// Spectra through the estimators: each wavelength is fitted as a grey material. The rows of a basis do not depend on
/// the wavelength, so that all wavelengths share one factorisation, each being a right-hand side. Principal components
/// (Nielsen et al. 2015, doi:10.1145/2816795.2818085, section 3) are learned of every channel of every material as a
/// grey one: nothing in them asks for three. Results: docs/results/spectra.md.

#include <gonio/basis/basis.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/table/spectral_samples.hpp>
#include <gonio/table/spectral_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio {

/// Spectral samples on given cells, a channel for each wavelength; those of weight zero are left out. Throws
/// gonio::error for unusable ones, or if all weights are zero. O(samples).
[[nodiscard]] located_samples locate_samples(const valid_cells& cells, const spectral_samples& samples,
                                             thread_count threads = {});

/// Spectra held as the weights of a basis, which all wavelengths share: offset + rows . weights in the metric's domain,
/// mapped back and clamped at zero, as in `fitted_brdf`.
template <basis Basis>
class fitted_spectra {
 public:
  /// Wavelengths in nanometres, ascending; `found` has a column of weights for each. Throws gonio::error if it has not.
  fitted_spectra(std::vector<double> wavelengths, Basis functions, solution found)
      : wavelengths_(std::move(wavelengths)), basis_(std::move(functions)), found_(std::move(found)) {
    require_wavelengths(wavelengths_);
    if (const Eigen::Index size = basis_.size(); found_.weights.rows() != size || found_.weights.cols() != bands())
      refuse({"a fit by ", size, " functions needs as many weights for each of ", bands(), " wavelengths"});
  }

  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  [[nodiscard]] Eigen::Index bands() const noexcept { return std::ssize(wavelengths_); }
  [[nodiscard]] const Basis& functions() const noexcept { return basis_; }
  /// (size of the basis) x wavelengths.
  [[nodiscard]] const Eigen::MatrixXd& weights() const noexcept { return found_.weights; }
  /// What the solver says of the weights, an entry for each wavelength.
  [[nodiscard]] const solve_report& report() const noexcept { return found_.report; }

  /// Reflectance in sr^-1 at each wavelength, at least zero; zero below the horizon. Reads one row of the basis.
  [[nodiscard]] Eigen::ArrayXd operator()(const direction& wi, const direction& wo) const {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return Eigen::ArrayXd::Zero(bands());
    const location at = locate(basis_.cells(), to_half_difference(wi, wo));
    Eigen::ArrayXd spectrum = (row_at(basis_, at) * found_.weights).transpose().array() + offset_at(basis_, at);
    for (double& value : spectrum) value = reflectance_of(basis_.metric(), value, at);
    return spectrum;
  }

  /// The fit of one wavelength, the same in all three channels.
  [[nodiscard]] fitted_brdf<Basis> at_wavelength(Eigen::Index band) const { return fit_of({band, band, band}); }

  /// Expands the fit to a table. Same bytes for any number of threads. The cost of a table in RGB for each three
  /// wavelengths.
  [[nodiscard]] spectral_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    spectral_table table(cells, wavelengths_);
    for (Eigen::Index first = 0; first < bands(); first += 3) {
      const Eigen::Index last = bands() - 1;
      const brdf_table three =
          fit_of({first, std::min(first + 1, last), std::min(first + 2, last)}).tabulate(cells, threads);
      for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
        for (Eigen::Index band = first; band < std::min(first + 3, bands()); ++band)
          table.values()(cell, band) = three.values()[3 * cell + band - first];
    }
    return table;
  }

 private:
  /// Three wavelengths in the places of red, green and blue.
  [[nodiscard]] fitted_brdf<Basis> fit_of(const std::array<Eigen::Index, 3>& columns) const {
    Eigen::MatrixXd weights(found_.weights.rows(), 3);
    for (Eigen::Index channel = 0; channel < 3; ++channel) weights.col(channel) = found_.weights.col(columns[channel]);
    return {basis_, std::move(weights)};
  }

  std::vector<double> wavelengths_;
  Basis basis_;
  solution found_;
};

/// An estimator whose channels share a basis, so that there may be any number of them: `decomposition` by principal
/// components or by `measured(...).as_grey()`.
template <class Estimator>
concept spectral_estimator = requires(const Estimator& candidate, const located_samples& samples) {
  { candidate.cells() } -> std::convertible_to<const valid_cells&>;
  requires basis<std::remove_cvref_t<decltype(candidate.solve_located(samples).functions)>>;
};

/// Fits each wavelength as a grey material. Throws gonio::error for unusable samples, or if the solver gives up. The
/// cost of a fit in RGB, and a right-hand side more for each wavelength beyond three.
///
/// ```cpp
/// const auto measured = gonio::io::read_cornell_spectra("garnet_red.brdf");
/// const auto paint = gonio::fit_spectra(gonio::decomposition{prior, gonio::tikhonov{40.0}}, measured);
/// const gonio::spectral_table table = paint.tabulate(gonio::valid_cells());
/// gonio::io::write_merl("incandescent.binary", table.colours(gonio::illuminant::a));
/// ```
template <spectral_estimator Estimator>
[[nodiscard]] auto fit_spectra(const Estimator& estimator, const spectral_samples& samples, thread_count threads = {}) {
  auto [functions, found] = estimator.solve_located(locate_samples(estimator.cells(), samples, threads));
  return fitted_spectra(samples.wavelengths, std::move(functions), std::move(found));
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/fitted_spectra.ipp>
#endif
