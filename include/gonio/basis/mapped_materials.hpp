#pragma once
/// Materials that are read a block of cells at a time, mapped relative to their median and centred: X - mu of Nielsen
/// et al. 2015 (doi:10.1145/2816795.2818085), Eq. 2-4, without holding X.

#include <gonio/metric/log_relative.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/table/material_rows.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio {

namespace detail {

/// Throws gonio::error naming the first material that is not finite in a row, the values of all at a cell.
void require_finite(const cell_matrix& rows, Eigen::Index row, Eigen::Index cell, const material_rows& materials);

}  // namespace detail

/// Rows of X - mu, a row for each cell, a column for each channel of each material. The first pass over the cells finds
/// the reference (the median of all columns, which a block of cells has) and the mean of each; later ones know them.
/// Whoever shares the cells among processes fills in what the others found. A value type whose copies share what was
/// found: 12 bytes a cell.
class mapped_materials {
 public:
  /// Throws gonio::error if there is no material.
  explicit mapped_materials(material_rows materials, cosine_weighting weighting = cosine_weighting::product);
  /// Relative to a known reference. Throws gonio::error unless it is over the materials' cells.
  mapped_materials(material_rows materials, const log_relative& metric);

  /// Rows whose reading also finds reference, mean and variation of their cells. Reading throws gonio::error naming the
  /// first material that is not finite at a cell.
  [[nodiscard]] row_source first_pass() const { return source(true); }
  /// The same rows of cells that the first pass has read.
  [[nodiscard]] row_source rows() const { return source(false); }

  [[nodiscard]] const material_rows& materials() const noexcept;
  /// What the first pass has found of each cell, and 0 of the others: the reference, unless it was known before; mu;
  /// and the squared norm of the row of X - mu.
  [[nodiscard]] std::span<float> reference() const noexcept;
  [[nodiscard]] std::span<float> mean() const noexcept;
  [[nodiscard]] std::span<float> variation() const noexcept;

  /// The squared norm of X - mu: of all rows, added in their order.
  [[nodiscard]] double total_variation() const noexcept;

  /// The metric, once all cells were read. Throws gonio::error for a reference that is no reflectance.
  [[nodiscard]] log_relative metric() const;

 private:
  struct state;
  [[nodiscard]] row_source source(bool first) const;

  std::shared_ptr<state> state_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/mapped_materials.ipp>
#endif
