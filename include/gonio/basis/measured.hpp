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
  /// or naming one and its first cell that is not finite.
  measured(material_set materials, Metric metric, thread_count threads = {})
      : names_(std::make_shared<const std::vector<std::string>>(std::move(materials.names))),
        cells_(std::move(materials.cells)),
        metric_(std::move(metric)) {
    const auto count = static_cast<Eigen::Index>(names_->size());
    if (count == 0 || materials.values.cols() != 3 * count ||
        materials.values.rows() != static_cast<Eigen::Index>(cells_.size()))
      throw error("a basis of measured materials needs at least one, with three columns each over " +
                  std::to_string(cells_.size()) + " cells");
    map_by_channel(materials.values, threads);
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
  void map_by_channel(cell_matrix& values, thread_count threads) const {
    const auto count = static_cast<Eigen::Index>(size());
    for_each_block(
        cells_.size(), 1024,
        [&](block range) {
          Eigen::RowVectorXf mapped(3 * count);
          for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            const location at = locate_cell(cells_, cell);
            auto row = values.row(static_cast<Eigen::Index>(cell));
            for (Eigen::Index i = 0; i < count; ++i)
              for (Eigen::Index c = 0; c < 3; ++c)
                mapped[c * count + i] = static_cast<float>(metric_.forward(row[3 * i + c], at));
            if (!mapped.allFinite()) refuse(mapped, cell);
            row = mapped;
          }
        },
        threads);
  }

  [[noreturn]] void refuse(const Eigen::RowVectorXf& mapped, std::size_t cell) const {
    Eigen::Index column = 0;
    while (std::isfinite(mapped[column])) ++column;
    throw error("material '" + (*names_)[static_cast<std::size_t>(column) % size()] + "' is not finite at cell " +
                std::to_string(cell));
  }

  std::shared_ptr<const std::vector<std::string>> names_;
  valid_cells cells_;
  Metric metric_;
  std::shared_ptr<const cell_matrix> mapped_;
  std::shared_ptr<const std::vector<Eigen::Index>> columns_;
};

}  // namespace gonio
