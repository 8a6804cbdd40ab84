#pragma once
/// Bodies of design/cell_candidates.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gonio::design {

GONIO_INLINE cell_candidates::cell_candidates(const valid_cells& cells, const cell_matrix& components,
                                              expected_error criterion, capture_constraint constraint,
                                              thread_count threads, std::span<const double> sample_noise_penalties)
    : geometry_(cells, std::move(constraint)),
      criterion_(std::move(criterion)),
      sample_noise_penalties_((cells.size() + error_sweep::width - 1) / error_sweep::width,
                              error_sweep::lanes::Constant(static_cast<float>(criterion_.noise_eta()))),
      threads_(threads) {
  if (!sample_noise_penalties.empty()) add_penalties(sample_noise_penalties);
  for (Eigen::Index cell = 0; cell < size(); ++cell)
    if (!geometry_.allows(cell)) excluded_.push_back(cell);
  write_tiles(components);
}

GONIO_INLINE void cell_candidates::write_tiles(const cell_matrix& components) {
  constexpr Eigen::Index width = error_sweep::width;
  const Eigen::Index m = criterion_.coefficients().rows(), columns = error_sweep::columns(m);
  const Eigen::MatrixXf to_materials = to_float(criterion_.coefficients()),
                        to_weighted = to_float(criterion_.weighted_coefficients());
  tiles_.resize(2 * width, std::ssize(sample_noise_penalties_) * columns);
  for_each_block(
      size(), sweep_block,
      [&](block range) {
        const Eigen::Index count = range.size(), tiles = (count + width - 1) / width;
        const float_matrix_view rows = components.middleRows(range.begin, count).transpose();
        Eigen::MatrixXf y = Eigen::MatrixXf::Zero(m, tiles * width), w = y;
        add_product(to_materials, rows, y.leftCols(count));
        add_product(to_weighted, rows, w.leftCols(count));
        for (Eigen::Index tile = 0; tile < tiles; ++tile) {
          auto own = tiles_.middleCols((range.begin / width + tile) * columns, columns);
          for (Eigen::Index i = 0; i < m; ++i)
            for (Eigen::Index lane = 0; lane < width; ++lane) {
              own(lane, i) = y(i, tile * width + lane);
              own(width + lane, i) = w(i, tile * width + lane);
            }
          own.rightCols(columns - m).setZero();
        }
      },
      threads_);
}

GONIO_INLINE expected_error::rows cell_candidates::rows_of(std::span<const Eigen::Index> cells) const {
  constexpr Eigen::Index width = error_sweep::width;
  const Eigen::Index n = std::ssize(cells), m = criterion_.coefficients().rows(), columns = error_sweep::columns(m);
  expected_error::rows rows(n, m);
  rows.noise.setOnes();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index tile = cells[i] / width, lane = cells[i] % width;
    const auto own = tiles_.middleCols(tile * columns, m);
    rows.materials().row(i) = own.row(lane).cast<double>();
    rows.weighted().row(i) = own.row(width + lane).cast<double>();
    rows.sample_noise_penalty[i] = double{sample_noise_penalties_[tile][lane]};
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
  constexpr Eigen::Index width = error_sweep::width;
  const error_sweep with(criterion_, rows_of(cells));
  const Eigen::Index columns = error_sweep::columns(criterion_.coefficients().rows());
  std::vector<float> errors(static_cast<std::size_t>(range.size()));
  for_each_block(
      range.size(), sweep_block,
      [&](block part) {
        const Eigen::Index tile = (range.begin + part.begin) / width, count = (part.size() + width - 1) / width;
        std::array<error_sweep::lanes, sweep_block / width> found;
        with(tiles_, tile * columns, {&sample_noise_penalties_[tile], static_cast<std::size_t>(count)},
             {found.data(), static_cast<std::size_t>(count)});
        std::copy_n(found[0].data(), part.size(), errors.data() + part.begin);
      },
      threads_);
  for (const Eigen::Index cell : excluded_)
    if (cell >= range.begin && cell < range.end)
      errors[static_cast<std::size_t>(cell - range.begin)] = std::numeric_limits<float>::infinity();
  return errors;
}

GONIO_INLINE void cell_candidates::add_penalties(std::span<const double> sample_noise_penalties) {
  if (std::ssize(sample_noise_penalties) != size())
    refuse({"expected ", size(), " per-cell penalties, got ", sample_noise_penalties.size()});
  for (Eigen::Index cell = 0; cell < size(); ++cell) {
    const double eta = sample_noise_penalties[cell];
    if (!(eta >= 0.0 && std::isfinite(eta)))
      refuse({"the penalty of a cell must be finite and not negative, not ", eta});
    sample_noise_penalties_[cell / error_sweep::width][cell % error_sweep::width] += static_cast<float>(eta);
  }
}

}  // namespace gonio::design
