#pragma once
/// Bodies of design/cell_candidates.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::design {

GONIO_INLINE cell_candidates::cell_candidates(const valid_cells& cells, const cell_matrix& components,
                                              expected_error criterion, capture_constraint constraint,
                                              thread_count threads, std::span<const double> sample_noise_penalties)
    : geometry_(cells, std::move(constraint)),
      criterion_(std::move(criterion)),
      materials_(cells.size(), criterion_.coefficients().rows()),
      weighted_(materials_.rows(), materials_.cols()),
      sample_noise_penalties_(Eigen::ArrayXf::Constant(materials_.rows(), static_cast<float>(criterion_.noise_eta()))),
      threads_(threads) {
  if (!sample_noise_penalties.empty()) sample_noise_penalties_ += checked(sample_noise_penalties, size());
  const Eigen::MatrixXf to_materials = criterion_.coefficients().cast<float>();
  const Eigen::MatrixXf to_weighted = criterion_.weighted_coefficients().cast<float>();
  for (Eigen::Index cell = 0; cell < size(); ++cell)
    if (!geometry_.allows(cell)) excluded_.push_back(cell);
  for_each_block(
      size(), 512,
      [&](block range) {
        const Eigen::Index begin = range.begin, count = range.size();
        const float_matrix_view rows = components.middleRows(begin, count).transpose();
        materials_.middleRows(begin, count).setZero();
        weighted_.middleRows(begin, count).setZero();
        add_product(to_materials, rows, materials_.middleRows(begin, count).transpose());
        add_product(to_weighted, rows, weighted_.middleRows(begin, count).transpose());
      },
      threads_);
}

GONIO_INLINE expected_error::rows cell_candidates::rows_of(std::span<const Eigen::Index> cells) const {
  const auto n = std::ssize(cells);
  expected_error::rows rows(n, materials_.cols());
  rows.noise.setOnes();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index cell = cells[i];
    rows.materials().row(i) = materials_.row(cell).cast<double>();
    rows.weighted().row(i) = weighted_.row(cell).cast<double>();
    rows.sample_noise_penalty[i] = double{sample_noise_penalties_[cell]};
  }
  return rows;
}

GONIO_INLINE double cell_candidates::operator()(std::span<const Eigen::Index> cells) const {
  return criterion_(rows_of(cells));
}

GONIO_INLINE cell_candidates::with_one_more cell_candidates::beside(std::span<const Eigen::Index> cells) const {
  return {*this, cells};
}

GONIO_INLINE cell_candidates::with_one_more::with_one_more(const cell_candidates& candidates,
                                                           std::span<const Eigen::Index> cells)
    : candidates_(&candidates), with_(candidates.criterion_, candidates.rows_of(cells)) {}

GONIO_INLINE double cell_candidates::with_one_more::operator()(Eigen::Index cell) const {
  const expected_error::rows row = candidates_->rows_of({&cell, 1});
  return with_(row.materials(), row.weighted(), row.sample_noise_penalty.array())[0];
}

GONIO_INLINE std::vector<float> cell_candidates::errors_with_each(std::span<const Eigen::Index> cells) const {
  return errors_with_each(cells, {0, size()});
}

GONIO_INLINE std::vector<float> cell_candidates::errors_with_each(std::span<const Eigen::Index> cells,
                                                                  block range) const {
  const extended_error<float> with(criterion_, rows_of(cells));
  std::vector<float> errors(static_cast<std::size_t>(range.size()));
  for_each_block(
      range.size(), sweep_block,
      [&](block part) {
        const Eigen::Index begin = range.begin + part.begin, count = part.size();
        Eigen::Map<Eigen::ArrayXf>(errors.data() + part.begin, count) =
            with(materials_.middleRows(begin, count), weighted_.middleRows(begin, count),
                 sample_noise_penalties_.segment(begin, count));
      },
      threads_);
  for (const Eigen::Index cell : excluded_)
    if (cell >= range.begin && cell < range.end)
      errors[static_cast<std::size_t>(cell - range.begin)] = std::numeric_limits<float>::infinity();
  return errors;
}

GONIO_INLINE Eigen::ArrayXf cell_candidates::checked(std::span<const double> sample_noise_penalties,
                                                     Eigen::Index cells) {
  if (std::ssize(sample_noise_penalties) != cells)
    refuse({"expected ", cells, " per-cell penalties, got ", sample_noise_penalties.size()});
  for (const double eta : sample_noise_penalties)
    if (!(eta >= 0.0 && std::isfinite(eta)))
      refuse("a cell's own eta must be finite and not negative, not " + std::to_string(eta));
  return Eigen::Map<const Eigen::ArrayXd>(sample_noise_penalties.data(), std::ssize(sample_noise_penalties))
      .cast<float>();
}

}  // namespace gonio::design
