#pragma once
/// Bodies of design/cell_candidates.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/expected_error.hpp>

#include <Eigen/Core>

#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE expected_error::rows cell_candidates::rows_of(std::span<const std::size_t> cells) const {
  const auto n = std::ssize(cells);
  expected_error::rows rows(n, materials_.cols());
  rows.noise.setOnes();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto cell = static_cast<Eigen::Index>(cells[static_cast<std::size_t>(i)]);
    rows.materials().row(i) = materials_.row(cell).cast<double>();
    rows.weighted().row(i) = weighted_.row(cell).cast<double>();
    rows.own_eta[i] = double{own_etas_[cell]};
  }
  return rows;
}

GONIO_INLINE std::vector<float> cell_candidates::errors_with_each(std::span<const std::size_t> cells) const {
  const extended_error<float> with(criterion_, rows_of(cells));
  std::vector<float> errors(size());
  for_each_block(
      size(), 128,
      [&](block range) {
        const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
        Eigen::Map<Eigen::ArrayXf>(errors.data() + range.begin, count) = with(
            materials_.middleRows(begin, count), weighted_.middleRows(begin, count), own_etas_.segment(begin, count));
      },
      threads_);
  for (const std::size_t cell : excluded_) errors[cell] = std::numeric_limits<float>::infinity();
  return errors;
}

GONIO_INLINE Eigen::ArrayXf cell_candidates::checked(std::span<const double> own_etas, std::size_t cells) {
  if (own_etas.size() != cells)
    throw error(std::to_string(own_etas.size()) + " etas of their own for " + std::to_string(cells) + " cells");
  for (const double eta : own_etas)
    if (!(eta >= 0.0 && std::isfinite(eta)))
      throw error("a cell's own eta must be finite and not negative, not " + std::to_string(eta));
  return Eigen::Map<const Eigen::ArrayXd>(own_etas.data(), std::ssize(own_etas)).cast<float>();
}

}  // namespace gonio
