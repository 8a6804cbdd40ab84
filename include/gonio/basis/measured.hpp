#pragma once
/// Measured materials as basis functions: Noell, Koehler and Stricker 2014, Eq. 3, 7 and 11, with the materials' tables
/// mapped by the metric.

#include <gonio/basis/basis.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/table/material_set.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// One colour channel of measured materials: function i is that channel of material i.
template <error_metric Metric>
class measured_channel {
 public:
  /// A view of `count` columns of mapped tables from `first` on, of which `columns` take part.
  measured_channel(std::shared_ptr<const cell_matrix> mapped, Eigen::Index first, Eigen::Index count, valid_cells cells,
                   Metric metric, std::shared_ptr<const std::vector<Eigen::Index>> columns)
      : mapped_(std::move(mapped)),
        first_(first),
        count_(count),
        cells_(std::move(cells)),
        metric_(std::move(metric)),
        columns_(std::move(columns)) {}

  /// Number of materials, those left out included.
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(count_); }
  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  [[nodiscard]] std::span<const float> row(std::size_t cell) const noexcept {
    return {mapped_->data() + static_cast<Eigen::Index>(cell) * mapped_->cols() + first_, size()};
  }
  [[nodiscard]] double offset(std::size_t /*cell*/) const noexcept { return 0.0; }
  /// The materials that take part in a fit, ascending.
  [[nodiscard]] std::span<const Eigen::Index> columns() const noexcept { return *columns_; }

  /// The Gram matrix of all materials over all cells, those left out included: with it, problems that leave materials
  /// out or explain one by the others (`leave_one_out`) need no data. O(cells size^2).
  [[nodiscard]] Eigen::MatrixXd products(thread_count threads = {}) const {
    return gram(mapped_->middleCols(first_, count_), threads);
  }

 private:
  std::shared_ptr<const cell_matrix> mapped_;
  Eigen::Index first_, count_;
  valid_cells cells_;
  Metric metric_;
  std::shared_ptr<const std::vector<Eigen::Index>> columns_;
};

/// Measured materials over the valid cells of a grid, one basis for each colour channel. A value type whose copies
/// share their storage of 12 bytes per cell and material.
///
/// ```cpp
/// const gonio::measured materials{gonio::expand(prior), gonio::log{}};
/// const auto paint = gonio::decomposition{materials.without({"chrome"}), gonio::nnls{}}.fit(samples);
/// ```
template <error_metric Metric>
class measured {
 public:
  /// Maps the tables in place: the set is consumed. O(cells x materials). Throws gonio::error if there is no material,
  /// or naming one and the first cell where it is not finite, before mapping or after.
  measured(material_set materials, Metric metric, thread_count threads = {})
      : cells_(materials.cells), metric_(std::move(metric)) {
    require_complete(materials);
    map_by_channel(materials, threads);
    names_ = std::make_shared<const std::vector<std::string>>(std::move(materials.names));
    mapped_ = std::make_shared<const cell_matrix>(std::move(materials.values));
    std::vector<Eigen::Index> all(names_->size());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    columns_ = std::make_shared<const std::vector<Eigen::Index>>(std::move(all));
  }

  /// Number of materials, those left out included.
  [[nodiscard]] std::size_t size() const noexcept { return names_->size(); }
  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return *names_; }
  /// The materials that take part in a fit, ascending.
  [[nodiscard]] std::span<const Eigen::Index> columns() const noexcept { return *columns_; }

  [[nodiscard]] measured_channel<Metric> channel(std::size_t index) const {
    const auto count = static_cast<Eigen::Index>(size());
    return {mapped_, static_cast<Eigen::Index>(index) * count, count, cells_, metric_, columns_};
  }

  /// The same basis in which the materials of these names take no part. Nothing is copied. Throws gonio::error for a
  /// name that there is not, or if none is left.
  [[nodiscard]] measured without(const std::vector<std::string>& excluded) const {
    for (const std::string& name : excluded)
      if (std::ranges::find(*names_, name) == names_->end())
        throw error("there is no material named '" + name + "' to leave out");
    std::vector<Eigen::Index> kept;
    for (const Eigen::Index column : *columns_)
      if (std::ranges::find(excluded, (*names_)[static_cast<std::size_t>(column)]) == excluded.end())
        kept.push_back(column);
    if (kept.empty()) throw error("all " + std::to_string(columns_->size()) + " materials are left out");
    measured fewer(*this);
    fewer.columns_ = std::make_shared<const std::vector<Eigen::Index>>(std::move(kept));
    return fewer;
  }

 private:
  /// Maps every value and sorts each row by channel: red of all materials, then green, then blue.
  void map_by_channel(material_set& materials, thread_count threads) const {
    const Eigen::Index count = materials.values.cols() / 3;
    for_each_block(
        cells_.size(), 1024,
        [&](block range) {
          Eigen::RowVectorXf sorted(3 * count);
          for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            const location at = locate_cell(cells_, cell);
            map_cell(materials, cell, [&](double rho) { return metric_.forward(rho, at); });
            auto row = materials.values.row(static_cast<Eigen::Index>(cell));
            for (Eigen::Index i = 0; i < count; ++i)
              for (Eigen::Index c = 0; c < 3; ++c) sorted[c * count + i] = row[3 * i + c];
            row = sorted;
          }
        },
        threads);
  }

  std::shared_ptr<const std::vector<std::string>> names_;
  valid_cells cells_;
  Metric metric_;
  std::shared_ptr<const cell_matrix> mapped_;
  std::shared_ptr<const std::vector<Eigen::Index>> columns_;
};

}  // namespace gonio
