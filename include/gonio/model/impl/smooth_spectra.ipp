#pragma once
/// Bodies of model/smooth_spectra.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/interpolated_colour.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/model/smooth_spectra.hpp>
#include <gonio/solve/least_squares_problem.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <utility>
#include <vector>

namespace gonio::model::detail {

[[nodiscard]] inline std::vector<double> every_20_nanometres() {
  std::vector<double> wavelengths;
  for (int nanometres = 380; nanometres <= 760; nanometres += 20) wavelengths.push_back(nanometres);
  return wavelengths;
}

/// Returns, as columns, the smoothest non-negative spectra whose colours are the columns of `colours`.
[[nodiscard]] inline Eigen::ArrayXXd smoothest_spectra(const std::vector<double>& wavelengths,
                                                       const Eigen::Matrix3d& colours) {
  const Eigen::MatrixXd weights = interpolated_colour(wavelengths);  // throws for a single wavelength
  const auto count = std::ssize(wavelengths);
  // Penalise second differences, and first differences with a small weight.
  constexpr double slope_weight = 0.05;
  row_matrix rows = row_matrix::Zero(2 * count - 3, count);
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    rows(i, i) = -slope_weight;
    rows(i, i + 1) = slope_weight;
    if (i + 2 < count) rows.row(count - 1 + i).segment(i, 3) << 1.0, -2.0, 1.0;
  }
  const least_squares_problem problem(std::move(rows), Eigen::VectorXd::Zero(2 * count - 3));
  Eigen::ArrayXXd spectra(count, 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const linear_constraints has_colour{.E = weights, .e = colours.col(c), .non_negative = true};
    spectra.col(c) = quadratic_program(has_colour).solve(problem).weights.col(0).array();
  }
  return spectra;
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE smooth_spectra::smooth_spectra() : smooth_spectra(detail::every_20_nanometres()) {}

GONIO_INLINE smooth_spectra::smooth_spectra(std::vector<double> wavelengths)
    : wavelengths_(std::move(wavelengths)),
      primaries_(detail::smoothest_spectra(wavelengths_, Eigen::Matrix3d::Identity())),
      secondaries_(detail::smoothest_spectra(wavelengths_, Eigen::Matrix3d::Ones() - Eigen::Matrix3d::Identity())) {}

GONIO_INLINE Eigen::ArrayXd smooth_spectra::operator()(const rgb& colour) const {
  Eigen::Index least = 0, most = 0;
  const double low = colour.minCoeff(&least), high = colour.maxCoeff(&most);
  if (least == most) return Eigen::ArrayXd::Constant(std::ssize(wavelengths_), low);
  const double middle = colour[3 - least - most];
  return low + (middle - low) * secondaries_.col(least) + (high - middle) * primaries_.col(most);
}

}  // namespace gonio::model
