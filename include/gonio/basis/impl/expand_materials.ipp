#pragma once
/// Bodies of basis/expand_materials.hpp.

#include <gonio/basis/expand_materials.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/spectrum.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gonio::detail {

GONIO_INLINE Eigen::MatrixXd colours_of_channels(std::span<const double> wavelengths) {
  if (wavelengths.empty()) return Eigen::MatrixXd::Identity(3, 3);
  if (wavelengths.size() == 1) return Eigen::MatrixXd::Ones(3, 1);
  const spectral_colour colour(wavelengths);
  std::vector<double> one(wavelengths.size());
  Eigen::MatrixXd weights(3, colour.size());
  for (Eigen::Index band = 0; band < colour.size(); ++band) {
    one[band] = 1.0;
    weights.col(band) = colour(one).matrix();
    one[band] = 0.0;
  }
  return weights;
}

}  // namespace gonio::detail
