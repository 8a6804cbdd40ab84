#pragma once
/// Every cell of a basis as a candidate for the next measurement: what E(S) of Xu et al. 2016, Eq. 15, becomes with
/// each of them, all at once.

#include <gonio/core/parallel.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/expected_error.hpp>

#include <Eigen/Core>

#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// The rows Y and W of all cells (see `expected_error`), in float: 8 bytes a cell and observation, or 2.4 GB for a
/// million cells and 270 observations. A prior that was learned with fewer cells (`gonio learn --thin`) needs less, and
/// loses little: docs/directions.md.
class cell_candidates {
 public:
  /// 4 k m operations a cell. `own_etas` are those of the errors that a measurement of each cell has of its own, such
  /// as `misplacement_etas`; none if it is empty. Throws gonio::error unless there is one for each cell, finite and not
  /// negative.
  template <error_metric Metric>
  cell_candidates(const pca<Metric>& basis, expected_error criterion, capture_constraint constraint = {},
                  thread_count threads = {}, std::span<const double> own_etas = {})
      : geometry_(basis.cells(), std::move(constraint)),
        criterion_(std::move(criterion)),
        materials_(static_cast<Eigen::Index>(basis.cells().size()), criterion_.coefficients().rows()),
        weighted_(materials_.rows(), materials_.cols()),
        own_etas_(Eigen::ArrayXf::Zero(materials_.rows())),
        threads_(threads) {
    if (!own_etas.empty()) own_etas_ = checked(own_etas, size());
    const Eigen::MatrixXf to_materials = criterion_.coefficients().transpose().cast<float>();
    const Eigen::MatrixXf to_weighted = criterion_.weighted_coefficients().transpose().cast<float>();
    for (std::size_t cell = 0; cell < size(); ++cell)
      if (!geometry_.allows(cell)) excluded_.push_back(cell);
    for_each_block(
        size(), 512,
        [&](block range) {
          const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
          const auto components = basis.components().middleRows(begin, count);
          materials_.middleRows(begin, count).noalias() = components * to_materials;
          weighted_.middleRows(begin, count).noalias() = components * to_weighted;
        },
        threads_);
  }

  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(materials_.rows()); }
  [[nodiscard]] const point_geometry& geometry() const noexcept { return geometry_; }
  [[nodiscard]] const expected_error& criterion() const noexcept { return criterion_; }

  /// Y and W of some cells.
  [[nodiscard]] expected_error::rows rows_of(std::span<const std::size_t> cells) const;

  /// E of measurements at some cells.
  [[nodiscard]] double operator()(std::span<const std::size_t> cells) const { return criterion_(rows_of(cells)); }

  /// E of measurements at some cells and one more, as a function of that cell: O(n m) instead of O(n^2 m).
  [[nodiscard]] auto beside(std::span<const std::size_t> cells) const {
    return [this, with = extended_error<double>(criterion_, rows_of(cells))](std::size_t cell) {
      const expected_error::rows row = rows_of({&cell, 1});
      return with(row.materials(), row.weighted(), row.own_eta.array())[0];
    };
  }

  /// E of measurements at some cells and, in turn, at each cell beside them: one value a cell, infinity for those
  /// that the constraint excludes. 8 n m operations a cell for n measurements and m observations; reads Y and W once.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const std::size_t> cells) const;

 private:
  [[nodiscard]] static Eigen::ArrayXf checked(std::span<const double> own_etas, std::size_t cells);

  point_geometry geometry_;
  expected_error criterion_;
  std::vector<std::size_t> excluded_;
  cell_matrix materials_, weighted_;
  Eigen::ArrayXf own_etas_;
  thread_count threads_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/cell_candidates.ipp>
#endif
