#pragma once
/// Functions that belong to materials, stored over the cells of a grid for each colour channel: the common base of
/// `measured` and `correction`.

#include <gonio/basis/basis.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// A Gram matrix that is computed on demand.
struct gram_on_demand {
  std::once_flag made;
  Eigen::MatrixXd matrix;
};

}  // namespace detail

/// One colour channel of functions that belong to materials: function i belongs to material i.
template <error_metric Metric>
class material_channel {
 public:
  /// Makes a view of `count` columns of mapped tables, starting with `first`, of which `columns` take part in fits.
  material_channel(std::shared_ptr<const cell_matrix> mapped, Eigen::Index first, Eigen::Index count, valid_cells cells,
                   Metric metric, std::shared_ptr<const std::vector<Eigen::Index>> columns,
                   std::shared_ptr<detail::gram_on_demand> gram)
      : mapped_(std::move(mapped)),
        first_(first),
        count_(count),
        cells_(std::move(cells)),
        metric_(std::move(metric)),
        columns_(std::move(columns)),
        gram_(std::move(gram)) {}

  /// Returns the number of functions, including those of excluded materials.
  [[nodiscard]] Eigen::Index size() const noexcept { return count_; }
  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  [[nodiscard]] std::span<const float> row(Eigen::Index cell) const noexcept {
    return std::span(mapped_->data() + cell * mapped_->cols() + first_, size());
  }
  [[nodiscard]] double offset(Eigen::Index /*cell*/) const noexcept { return 0.0; }
  /// Returns the numbers of the functions that take part in a fit, ascending.
  [[nodiscard]] std::span<const Eigen::Index> columns() const noexcept { return *columns_; }

  /// Returns all functions over all cells: cells x size, a view.
  [[nodiscard]] auto values() const { return mapped_->middleCols(first_, count_); }

  /// Returns the Gram matrix of all functions over all cells, including those of excluded materials. With it, problems
  /// that exclude materials, or that explain one material by all others (`leave_one_out`), need not read the tables.
  /// O(cells size^2) the first time; all copies of the functions, with any exclusions, share it.
  [[nodiscard]] const Eigen::MatrixXd& products(thread_count threads = {}) const {
    std::call_once(gram_->made, [&] { gram_->matrix = gram(values(), threads); });
    return gram_->matrix;
  }

 private:
  std::shared_ptr<const cell_matrix> mapped_;
  Eigen::Index first_, count_;
  valid_cells cells_;
  Metric metric_;
  std::shared_ptr<const std::vector<Eigen::Index>> columns_;
  std::shared_ptr<detail::gram_on_demand> gram_;
};

/// Functions over the valid cells of a grid, the same number for each colour channel. The first ones belong to named
/// materials, which can be excluded. Any further functions take part in every fit. A value type; copies share their
/// storage of 12 bytes per cell and function.
template <error_metric Metric>
class material_functions {
 public:
  /// `mapped` is cells x 3 size: red of all functions, then green, then blue. Throws gonio::error if the sizes do not
  /// match.
  material_functions(std::vector<std::string> names, valid_cells cells, Metric metric, cell_matrix mapped)
      : names_(std::make_shared<const std::vector<std::string>>(std::move(names))),
        cells_(std::move(cells)),
        metric_(std::move(metric)),
        mapped_(std::make_shared<const cell_matrix>(std::move(mapped))) {
    if (mapped_->cols() % 3 != 0 || mapped_->cols() < 3 * std::ssize(*names_) || mapped_->cols() == 0 ||
        mapped_->rows() != cells_.size())
      refuse({"functions of ", names_->size(), " materials over ", cells_.size(), " cells do not match in size"});
    std::vector<Eigen::Index> all(size());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    columns_ = std::make_shared<const std::vector<Eigen::Index>>(std::move(all));
    for (auto& gram : grams_) gram = std::make_shared<detail::gram_on_demand>();
  }

  /// Returns the number of functions, including those of excluded materials.
  [[nodiscard]] Eigen::Index size() const noexcept { return mapped_->cols() / 3; }
  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return *names_; }
  /// Returns the numbers of the functions that take part in a fit, ascending.
  [[nodiscard]] std::span<const Eigen::Index> columns() const noexcept { return *columns_; }

  /// Returns the names of the excluded materials.
  [[nodiscard]] std::vector<std::string> excluded() const {
    std::vector<std::string> found;
    for (Eigen::Index i = 0; i < std::ssize(*names_); ++i)
      if (!std::ranges::binary_search(*columns_, i)) found.push_back((*names_)[i]);
    return found;
  }

  [[nodiscard]] material_channel<Metric> channel(Eigen::Index index) const {
    const Eigen::Index count = size();
    return {mapped_, index * count, count, cells_, metric_, columns_, grams_[index]};
  }

  /// Returns all functions of all channels as one basis, for data without colour channels. Each channel of a measured
  /// material counts as a grey material, as for principal components (Nielsen et al. 2015, section 3). A view of 3
  /// size() functions: red of all, then green, then blue. Excluded materials take no part.
  [[nodiscard]] material_channel<Metric> as_grey() const {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      for (const Eigen::Index column : *columns_) columns.push_back(channel * size() + column);
    return {mapped_,
            0,
            mapped_->cols(),
            cells_,
            metric_,
            std::make_shared<const std::vector<Eigen::Index>>(std::move(columns)),
            std::make_shared<detail::gram_on_demand>()};
  }

 protected:
  /// Returns all functions of all channels: cells x 3 size.
  [[nodiscard]] const cell_matrix& mapped() const noexcept { return *mapped_; }

  /// Excludes the functions of these materials from fits, without a copy. Throws gonio::error for an unknown name, or
  /// if no material is left.
  void leave_out(const std::vector<std::string>& excluded) {
    for (const std::string& name : excluded)
      if (std::ranges::find(*names_, name) == names_->end())
        refuse({"there is no material named '", name, "' to leave out"});
    const auto is_out = [&](Eigen::Index i) {
      return i < std::ssize(*names_) && std::ranges::find(excluded, (*names_)[i]) != excluded.end();
    };
    std::vector<Eigen::Index> kept;
    std::ranges::copy_if(*columns_, std::back_inserter(kept), [&](Eigen::Index column) { return !is_out(column); });
    if (kept.empty() || kept.front() >= std::ssize(*names_))
      refuse({"all ", columns_->size() - kept.size(), " materials are left out"});
    columns_ = std::make_shared<const std::vector<Eigen::Index>>(std::move(kept));
  }

 private:
  std::shared_ptr<const std::vector<std::string>> names_;
  valid_cells cells_;
  Metric metric_;
  std::shared_ptr<const cell_matrix> mapped_;
  std::shared_ptr<const std::vector<Eigen::Index>> columns_;
  std::array<std::shared_ptr<detail::gram_on_demand>, 3> grams_;
};

}  // namespace gonio
