#pragma once
/// Every cell of a basis as a candidate for the next measurement. Computes E(S) of Xu et al. 2016
/// (doi:10.1145/2980179.2982396), Eq. 15, with each cell added to S, in one sweep.

#include <gonio/core/parallel.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/error_sweep.hpp>
#include <gonio/design/expected_error.hpp>

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

namespace gonio::design {

/// The rows Y and W of all cells (see `expected_error`), in float. They need 8 bytes per cell and observation: 2.4 GB
/// for 1.1 million cells and 270 observations. A prior with fewer cells (`gonio learn --thin`) needs less and loses
/// little: docs/results/directions.md.
class cell_candidates {
 public:
  /// Costs 4 k m operations per cell for k components and m observations. `sample_noise_penalties` is empty or has a
  /// penalty for each cell: m times the error variance of a measurement there (`reading_variances`), without the noise
  /// in the criterion's options. Throws gonio::error unless there is one for each cell, and each is finite and not
  /// negative.
  template <error_metric Metric>
  cell_candidates(const pca<Metric>& basis, expected_error criterion, capture_constraint constraint = {},
                  thread_count threads = {}, std::span<const double> sample_noise_penalties = {})
      : cell_candidates(basis.cells(), basis.components(), std::move(criterion), std::move(constraint), threads,
                        sample_noise_penalties) {}

  [[nodiscard]] Eigen::Index size() const noexcept { return geometry_.size(); }
  [[nodiscard]] const point_geometry& geometry() const noexcept { return geometry_; }
  [[nodiscard]] const expected_error& criterion() const noexcept { return criterion_; }

  /// Returns Y and W at some cells.
  [[nodiscard]] expected_error::rows rows_of(std::span<const Eigen::Index> cells) const;

  /// Returns the expected error E after measurements at some cells.
  [[nodiscard]] double operator()(std::span<const Eigen::Index> cells) const;

  /// A function of one cell: returns E of measurements at some cells and at this cell.
  class with_one_more;

  /// Returns the function that adds one more cell to n cells. A call costs O(n m) instead of O(n^2 m) for m
  /// observations. The function refers to this object.
  [[nodiscard]] with_one_more beside(std::span<const Eigen::Index> cells) const;

  /// Returns one value for each cell: E of measurements at `cells` and at this cell, or infinity if the constraint
  /// excludes it. 10 n m operations per cell for n measurements and m observations. Reads Y and W once.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> cells) const;

  /// Returns the values of `errors_with_each(cells)`, byte for byte, for a range of cells. The range must begin at a
  /// multiple of `sweep_block`.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> cells, block range) const;

  static constexpr Eigen::Index sweep_block = 128;

 private:
  cell_candidates(const valid_cells& cells, const cell_matrix& components, expected_error criterion,
                  capture_constraint constraint, thread_count threads, std::span<const double> sample_noise_penalties);

  void write_tiles(const cell_matrix& components);
  void add_penalties(std::span<const double> sample_noise_penalties);

  point_geometry geometry_;
  expected_error criterion_;
  std::vector<Eigen::Index> excluded_;
  error_sweep::tiles tiles_;  ///< Y and W in tiles of eight cells
  std::vector<error_sweep::lanes> sample_noise_penalties_;
  thread_count threads_;
};

class cell_candidates::with_one_more {
 public:
  with_one_more(const cell_candidates& candidates, std::span<const Eigen::Index> cells);

  [[nodiscard]] double operator()(Eigen::Index cell) const;

 private:
  const cell_candidates* candidates_;
  extended_error<double> with_;
};

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/cell_candidates.ipp>
#endif
