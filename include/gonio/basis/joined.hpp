#pragma once
/// Joins two bases into one: components and a discrepancy, or components and a constant.

#include <gonio/basis/combine.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <span>
#include <utility>

namespace gonio {

/// The functions of one basis followed by those of another, over the same cells, in the domain of the first basis'
/// metric. Their offsets are added. A computed basis: rows are read from both.
template <basis First, basis Second>
class joined {
 public:
  static constexpr bool arbitrary_sign = has_arbitrary_sign<First> || has_arbitrary_sign<Second>;

  /// Throws gonio::error if the two bases are over different cells.
  joined(First first, Second second) : first_(std::move(first)), second_(std::move(second)) {
    if (!(first_.cells() == second_.cells())) refuse("joined bases must be over the same cells");
  }

  [[nodiscard]] const First& first() const noexcept { return first_; }
  [[nodiscard]] const Second& second() const noexcept { return second_; }

  [[nodiscard]] Eigen::Index size() const noexcept { return first_size() + second_.size(); }
  [[nodiscard]] const auto& cells() const noexcept { return first_.cells(); }
  [[nodiscard]] const auto& metric() const noexcept { return first_.metric(); }
  [[nodiscard]] double offset(Eigen::Index cell) const noexcept { return first_.offset(cell) + second_.offset(cell); }

  void read_row(const location& at, function_row out) const noexcept {
    read_row_at(first_, at, Eigen::Map<Eigen::RowVectorXd>(out.data(), first_size()));
    read_row_at(second_, at, Eigen::Map<Eigen::RowVectorXd>(out.data() + first_size(), out.size() - first_size()));
  }

  void read_rows(std::span<const location> at, row_block out) const {
    read_rows_at(first_, at, columns_of_block(out, 0, first_size()));
    read_rows_at(second_, at, columns_of_block(out, first_size(), out.cols() - first_size()));
  }

  [[nodiscard]] cell_fields<3> combination(const Eigen::MatrixXd& weights, thread_count threads = {}) const requires
      combinable_basis<First> && combinable_basis<Second> {
    cell_fields<3> sum = combine(first_, weights.topRows(first_size()), threads);
    sum += combine(second_, weights.bottomRows(weights.rows() - first_size()), threads);
    return sum;
  }

 private:
  [[nodiscard]] Eigen::Index first_size() const noexcept { return first_.size(); }

  First first_;
  Second second_;
};

}  // namespace gonio
