#pragma once
/// A BRDF held as the weights of a basis, and its expansion to tables (Nielsen et al. 2015, Eq. 10).

#include <gonio/basis/basis.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/solve/solver.hpp>
#include <gonio/table/upsample.hpp>

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// offset + rows . weights in the metric's domain, mapped back and clamped at zero: a BRDF, and what the
/// solver said about it. Evaluation costs O(8 x size of the basis); tabulate for the inner loop of a
/// renderer.
template <basis Basis>
class fitted_brdf {
 public:
  /// `found.weights` is (size of the basis) x 3, one column per colour channel.
  fitted_brdf(Basis basis, solution found)
      : basis_(std::move(basis)), found_(std::move(found)), weights_(found_.weights.template cast<float>()) {
    if (weights_.rows() != static_cast<Eigen::Index>(basis_.size()) || weights_.cols() != 3)
      throw error("a fit by " + std::to_string(basis_.size()) +
                  " functions needs as many weights for each of 3 channels");
  }

  [[nodiscard]] const Basis& functions() const noexcept { return basis_; }
  /// The solver's weights, residuals and certificate, one for each colour channel.
  [[nodiscard]] const solution& found() const noexcept { return found_; }

  /// Reflectance in sr^-1, at least zero; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const location at = locate(basis_.cells(), to_half_difference(wi, wo));
    const rgb y = interpolate(
        at, [&](std::size_t cell) { return mapped(cell); }, rgb(rgb::Zero()));
    return reflectance(y, at);
  }

  /// The value at a cell of the basis in the metric's domain.
  [[nodiscard]] rgb mapped(std::size_t cell) const noexcept {
    const std::span<const float> row = basis_.row(cell);
    const Eigen::Map<const Eigen::RowVectorXf> functions(row.data(), static_cast<Eigen::Index>(row.size()));
    return (functions * weights_).transpose().template cast<double>().array() + basis_.offset(cell);
  }

  /// Expands the fit to a table: one product of the basis' rows with the weights, which reads the basis once,
  /// and where the cells are others an interpolation of its three channels. Same bytes for any number of
  /// threads.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const {
    if constexpr (std::same_as<std::remove_cvref_t<decltype(basis_.metric())>, log_relative>)
      return tabulate_rows(cells, threads);
    else
      return tabulate_cells(cells, threads);
  }

  /// The same table through the metric's own `inverse` at each cell: slower, and works with any metric.
  [[nodiscard]] brdf_table tabulate_cells(const valid_cells& cells, thread_count threads = {}) const {
    const mapped_fields field = mapped_field(threads);
    const auto value = [&](std::size_t cell) {
      return field.col(static_cast<Eigen::Index>(cell)).template cast<double>();
    };
    const bool own = cells == basis_.cells();
    brdf_table table(cells);
    for_each_block(
        cells.size(), 4096,
        [&](block range) {
          for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            const location at = own ? locate_cell(cells, cell) : locate(basis_.cells(), cells.angles(cell));
            table.set(cell, reflectance(interpolate(at, value, rgb(rgb::Zero())), at));
          }
        },
        threads);
    return table;
  }

  /// Red, green and blue over all cells of the basis, in the metric's domain.
  using mapped_fields = Eigen::Array<float, 3, Eigen::Dynamic>;

  [[nodiscard]] mapped_fields mapped_field(thread_count threads = {}) const {
    mapped_fields field(3, static_cast<Eigen::Index>(basis_.cells().size()));
    for_each_block(
        basis_.cells().size(), 4096,
        [&](block range) {
          for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            // Three contiguous dot products run at the speed of reading the row.
            const Eigen::Map<const Eigen::VectorXf> row(basis_.row(cell).data(), weights_.rows());
            const auto offset = static_cast<float>(basis_.offset(cell));
            for (Eigen::Index channel = 0; channel < 3; ++channel)
              field(channel, static_cast<Eigen::Index>(cell)) = weights_.col(channel).dot(row) + offset;
          }
        },
        threads);
    return field;
  }

 private:
  /// With the log-relative metric, the logarithm of the reference is interpolated with the three channels and
  /// a row of cells is mapped back at once.
  [[nodiscard]] brdf_table tabulate_rows(const valid_cells& cells, thread_count threads) const {
    const auto& metric = basis_.metric();
    cell_fields<4> fields(4, static_cast<Eigen::Index>(basis_.cells().size()));
    fields.template topRows<3>() = mapped_field(threads);
    for (Eigen::Index cell = 0; cell < fields.cols(); ++cell)
      fields(3, cell) =
          static_cast<float>(log_relative::log_reference(metric.reference()[static_cast<std::size_t>(cell)]));

    const grid& target = cells.grid();
    std::vector<double> cos_phi;
    for (int k = 0; k < target.extents().phi_d; ++k) cos_phi.push_back(std::cos(target.phi_d(k)));
    brdf_table table(cells);
    upsample<4>(
        basis_.cells(), fields, cells,
        [&](const cell_row& row, auto& values) {
          // cos_i cos_o = (sum - difference cos phi_d) (sum + difference cos phi_d), as in `cosines`.
          const double sum = std::cos(row.theta_h) * std::cos(row.theta_d);
          const double difference = std::sin(row.theta_h) * std::sin(row.theta_d);
          std::array<float, 4096> weight;  // no grid has longer rows
          for (std::size_t i = 0; i < row.count; ++i) {
            const double part = difference * cos_phi[static_cast<std::size_t>(row.phi_d[i])];
            weight[i] = static_cast<float>(log_relative::cosine_weight({sum - part, sum + part}));
          }
          log_relative::inverse_clamped(values, std::span(weight).first(row.count),
                                        table.values().subspan(3 * row.first, 3 * row.count));
        },
        threads);
    return table;
  }

  [[nodiscard]] rgb reflectance(const rgb& y, const location& at) const noexcept {
    const auto& metric = basis_.metric();
    return rgb(metric.inverse(y.x(), at), metric.inverse(y.y(), at), metric.inverse(y.z(), at)).max(0.0);
  }

  Basis basis_;
  solution found_;
  Eigen::Matrix<float, Eigen::Dynamic, 3> weights_;
};

}  // namespace gonio
