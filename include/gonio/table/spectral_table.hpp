#pragma once
/// A table of a BRDF's spectra over the valid cells of a grid.

#include <gonio/core/parallel.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/cell_matrix.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <functional>
#include <span>
#include <vector>

namespace gonio {

/// Reflectance in sr^-1 at w wavelengths, tabulated over valid cells, cell-major: the spectrum of a cell is contiguous.
/// 31 wavelengths over MERL's grid take 136 MB. The class does not model `brdf`, whose values are colours. `colours`
/// and `at_wavelength` return a `brdf_table`, which does.
class spectral_table {
 public:
  /// Makes a table of zeros. Wavelengths are in nanometres. Throws gonio::error unless they are positive, finite and
  /// ascending.
  spectral_table(valid_cells cells, std::vector<double> wavelengths);

  /// Takes values of shape (cells, w). Throws gonio::error for another shape or invalid wavelengths.
  spectral_table(valid_cells cells, std::vector<double> wavelengths, cell_matrix values);

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  /// Returns the wavelengths in nanometres, ascending.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  /// Returns the number of wavelengths, w.
  [[nodiscard]] Eigen::Index bands() const noexcept { return values_.cols(); }
  /// Returns the values, cells x w.
  [[nodiscard]] const cell_matrix& values() const noexcept { return values_; }
  [[nodiscard]] cell_matrix& values() noexcept { return values_; }

  /// Returns the w reflectances of a cell.
  [[nodiscard]] std::span<const float> at(Eigen::Index cell) const noexcept {
    return {values_.data() + cell * bands(), static_cast<std::size_t>(bands())};
  }

  /// Interpolates the spectrum of a pair of directions trilinearly, w values; zero below the horizon.
  [[nodiscard]] Eigen::ArrayXf operator()(const direction& wi, const direction& wo) const {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return Eigen::ArrayXf::Zero(bands());
    return at(locate(cells_, to_half_difference(wi, wo)));
  }

  /// Interpolates the spectrum at a location on this table's cells.
  [[nodiscard]] Eigen::ArrayXf at(const location& at) const;

  /// Returns the reflectance at one wavelength, as a table whose three channels are equal.
  [[nodiscard]] brdf_table at_wavelength(Eigen::Index band) const;

  /// Returns the table as linear Rec. 709 under an illuminant (`spectral_colour`); one wavelength is grey. Throws
  /// gonio::error if none of several wavelengths is visible.
  [[nodiscard]] brdf_table colours(illuminant light = illuminant::d65, thread_count threads = {}) const;

 private:
  valid_cells cells_;
  std::vector<double> wavelengths_;
  cell_matrix values_;
};

/// Makes a table from tables of three wavelengths each, stored as red, green and blue: `three(first)` returns the table
/// of three wavelengths, starting with number `first`. Ignores channels after the last wavelength.
[[nodiscard]] spectral_table tabulate_by_threes(const valid_cells& cells, std::vector<double> wavelengths,
                                                const std::function<brdf_table(Eigen::Index first)>& three);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/spectral_table.ipp>
#endif
