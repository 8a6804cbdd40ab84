#pragma once
/// A BRDF as weights of a basis, and its expansion to tables (Nielsen et al. 2015, doi:10.1145/2816795.2818085, Eq.
/// 10).

#include <gonio/basis/combine.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/solve/solver.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/spectral_table.hpp>
#include <gonio/table/upsample.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

#if defined(GONIO_COMPILED)  // fits by measured materials are compiled in gonio::compiled
#include <gonio/basis/measured.hpp>
#endif

namespace gonio {

/// A BRDF: the basis' offset plus the product of its row with the weights, mapped back to reflectance and clamped at
/// zero. Holds the solver's report if a solver found the weights. Channels that share a basis may be colours, one
/// value, or wavelengths; each wavelength is a grey material. An evaluation costs O(8 x size of the basis) or, if the
/// basis computes its rows, one row. For the inner loop of a renderer, tabulate the fit.
///
/// Colours are computed from stored rows in float. `values`, wavelengths and computed rows use double, because
/// functions given by a formula may cancel each other to many digits.
template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells>
class fitted_brdf {
 public:
  /// The largest size of a basis that computes its rows. The row is kept on the stack, so that evaluation does not
  /// allocate.
  static constexpr int most_computed_functions = 4096;

  /// `weights` is (size of the basis) x channels. Throws gonio::error for another size, for a basis of more than
  /// `most_computed_functions` that computes its rows, or if each channel has its own basis but the channels are not
  /// colours.
  fitted_brdf(Basis basis, Eigen::MatrixXd weights, std::optional<solve_report> report = {},
              gonio::channels kinds = {});

  fitted_brdf(Basis basis, solution found, gonio::channels kinds = {})
      : fitted_brdf(std::move(basis), std::move(found.weights), std::move(found.report), std::move(kinds)) {}

  [[nodiscard]] const Basis& functions() const noexcept { return basis_; }
  /// Returns the weights, (size of the basis) x channels.
  [[nodiscard]] const Eigen::MatrixXd& weights() const noexcept { return weights_; }
  /// Returns the channels that the columns of the weights stand for.
  [[nodiscard]] const gonio::channels& channels() const noexcept { return kinds_; }
  /// Returns the solver's report; nothing if no solver found the weights.
  [[nodiscard]] const std::optional<solve_report>& report() const noexcept { return report_; }

  /// Returns the reflectance in sr^-1 as a colour, at least zero; zero below the horizon. Converts wavelengths by
  /// `channels::colour`.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return {0.0, 0.0, 0.0};
    return at(locate(basis_.cells(), to_half_difference(wi, wo)));
  }

  /// Returns the reflectance in sr^-1 in each channel, at least zero; zero below the horizon.
  [[nodiscard]] Eigen::ArrayXd values(const direction& wi, const direction& wo) const {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return Eigen::ArrayXd::Zero(kinds_.size());
    return values(locate(basis_.cells(), to_half_difference(wi, wo)));
  }
  /// Returns the reflectance in sr^-1 in each channel at a location on the basis' cells, at least zero.
  [[nodiscard]] Eigen::ArrayXd values(const location& here) const {
    if constexpr (basis<Basis>) {
      const Eigen::RowVectorXd row = row_at(basis_, here);
      const double offset = offset_at(basis_, here);
      Eigen::ArrayXd all(weights_.cols());
      for (Eigen::Index c = 0; c < all.size(); ++c)
        all[c] = reflectance_of(basis_.metric(), dot(row.data(), &weights_(0, c), row.size()) + offset, here);
      return all;
    } else {
      return at(here);
    }
  }

  /// Returns the derivatives of each channel's reflectance by its own weights, in sr^-1, in the shape of `weights()`.
  /// Zero below the horizon and where the reflectance is clamped. Computed by central differences of the metric's
  /// inverse, accurate to eight digits. O(8 x size of the basis).
  [[nodiscard]] Eigen::MatrixXd gradient(const direction& wi, const direction& wo) const requires basis<Basis> {
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(weights_.rows(), weights_.cols());
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return slopes;
    constexpr double step = 1e-4;
    const location here = locate(basis_.cells(), to_half_difference(wi, wo));
    const Eigen::RowVectorXd row = row_at(basis_, here);
    const double offset = offset_at(basis_, here);
    const auto reflectance = [&](double y) { return basis_.metric().inverse(y, here); };
    for (Eigen::Index c = 0; c < weights_.cols(); ++c) {
      const double y = dot(row.data(), &weights_(0, c), row.size()) + offset;
      if (reflectance(y) > 0.0)
        slopes.col(c) = (reflectance(y + step) - reflectance(y - step)) / (2.0 * step) * row.transpose();
    }
    return slopes;
  }

  /// Returns the cells that locations for `at` refer to.
  [[nodiscard]] const valid_cells& cells() const noexcept { return basis_.cells(); }

  /// Returns the reflectance in sr^-1 at a location on the basis' cells, at least zero.
  [[nodiscard]] rgb at(const location& here) const noexcept {
    if (kinds_.are_wavelengths()) {
      const Eigen::ArrayXd spectrum = values(here);
      return kinds_.colour({spectrum.data(), static_cast<std::size_t>(spectrum.size())});
    }
    return reflectance(mapped_at(here), here);
  }

  /// Returns the value at a cell of the basis in the metric's domain: a colour, or the first three channels. If there
  /// are fewer than three, repeats the last.
  [[nodiscard]] rgb mapped(Eigen::Index cell) const noexcept {
    if constexpr (computed)
      return mapped_at(locate_cell(basis_.cells(), cell));
    else
      return {stored_value(cell, 0), stored_value(cell, 1), stored_value(cell, 2)};
  }

  /// Expands the fit to a table of colours. Multiplies the basis' rows by the weights, which reads the basis once. If
  /// `cells` are not the cells of the basis, interpolates the three channels between the cells of the basis. Computed
  /// rows are evaluated at the cells of the table, unless the basis combines its functions at all of its own cells
  /// (`combining_basis`). Wavelengths become colours, black if none is visible; `tabulate_spectra` keeps them. Any
  /// number of threads gives the same bytes.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells, thread_count threads = {}) const;

  /// Expands a fit of wavelengths. Costs one table of colours for every three wavelengths. Throws gonio::error for
  /// other channels.
  [[nodiscard]] spectral_table tabulate_spectra(const valid_cells& cells,
                                                thread_count threads = {}) const requires basis<Basis>;

  /// Expands the fit by the metric's `inverse` at each cell. Works with any metric, but is slower than `tabulate` if
  /// rows are stored.
  [[nodiscard]] brdf_table tabulate_cells(const valid_cells& cells, thread_count threads = {}) const;

  /// The values of `mapped` at all cells of the basis: 3 x cells.
  using mapped_fields = Eigen::Array<float, 3, Eigen::Dynamic>;

  [[nodiscard]] mapped_fields mapped_field(thread_count threads = {}) const;

 private:
  using metric_type = std::remove_cvref_t<decltype(std::declval<const Basis&>().metric())>;
  using channel_type = std::remove_cvref_t<decltype(channel_of(std::declval<const Basis&>(), 0))>;
  struct no_channels {};
  using own_channels = std::conditional_t<basis<Basis>, no_channels, std::array<channel_type, 3>>;
  static constexpr bool computed = computed_basis<channel_type>;
  static constexpr bool combinable = !computed || combining_basis<Basis>;

  [[nodiscard]] const channel_type& functions_of([[maybe_unused]] Eigen::Index channel) const noexcept {
    if constexpr (basis<Basis>)
      return basis_;
    else
      return channels_[channel];
  }
  [[nodiscard]] static own_channels channels_of([[maybe_unused]] const Basis& functions) {
    if constexpr (basis<Basis>)
      return {};
    else
      return {functions.channel(0), functions.channel(1), functions.channel(2)};
  }

  /// Returns three columns of the weights, starting with `first`. If there are fewer, repeats the last one.
  [[nodiscard]] Eigen::MatrixXd three_columns(Eigen::Index first) const {
    Eigen::MatrixXd three(weights_.rows(), 3);
    for (Eigen::Index c = 0; c < 3; ++c)
      std::copy_n(&weights_(0, std::min(first + c, weights_.cols() - 1)), three.rows(), &three(0, c));
    return three;
  }

  /// Returns one channel at a cell: a contiguous dot product that is as fast as reading the row.
  [[nodiscard]] float stored_value(Eigen::Index cell, Eigen::Index channel) const noexcept requires(!computed) {
    const float* weights = float_weights_.data() + channel * weights_.rows();
    const channel_type& functions = functions_of(channel);
    return dot(weights, functions.row(cell).data(), weights_.rows()) + static_cast<float>(functions.offset(cell));
  }

  [[nodiscard]] rgb mapped_at(const location& at) const noexcept {
    if constexpr (computed)
      return computed_value(at);
    else
      return interpolated_value(at);
  }

  [[nodiscard]] rgb interpolated_value(const location& at) const noexcept {
    rgb sum(0.0, 0.0, 0.0);
    for (int corner = 0; corner < at.count; ++corner) {
      const rgb value = mapped(at.cell[corner]);
      for (Eigen::Index channel = 0; channel < 3; ++channel) sum[channel] += at.weight[corner] * value[channel];
    }
    return sum;
  }

  /// Returns the three channels at a location. Computes a single row if the channels share their basis.
  [[nodiscard]] rgb computed_value(const location& at) const noexcept requires computed {
    Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, most_computed_functions> row(weights_.rows());
    rgb value;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const channel_type& functions = functions_of(c);
      if (c == 0 || !basis<Basis>) functions.read_row(at, row);
      value[c] = dot(row.data(), &weights_(0, std::min(c, weights_.cols() - 1)), row.size()) + offset_at(functions, at);
    }
    return value;
  }

  /// Expands the fit row by row from three channels and the metric's companion values.
  [[nodiscard]] brdf_table tabulate_rows(const valid_cells& cells, thread_count threads) const;

  [[nodiscard]] rgb reflectance(const rgb& y, const location& at) const noexcept {
    const auto& metric = basis_.metric();
    return {reflectance_of(metric, y.x(), at), reflectance_of(metric, y.y(), at), reflectance_of(metric, y.z(), at)};
  }

  Basis basis_;
  [[no_unique_address]] own_channels channels_;  ///< the basis of each channel, unless all share one
  Eigen::MatrixXd weights_;
  std::optional<solve_report> report_;
  gonio::channels kinds_;
  Eigen::MatrixXf float_weights_;  // weights of three channels, for products with stored rows
};

template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells> fitted_brdf<Basis>::fitted_brdf(Basis basis,
                                                                                     Eigen::MatrixXd weights,
                                                                                     std::optional<solve_report> report,
                                                                                     gonio::channels kinds)
    : basis_(std::move(basis)),
      channels_(channels_of(basis_)),
      weights_(std::move(weights)),
      report_(std::move(report)),
      kinds_(std::move(kinds)) {
  if (const Eigen::Index size = basis_.size(); weights_.rows() != size || weights_.cols() != kinds_.size())
    refuse({"a fit of ", size, " functions needs one weight per function for each of ", kinds_.size(), " channels"});
  if (!gonio::basis<Basis> && !kinds_.are_colours())
    refuse("a channelwise basis needs the channels red, green and blue");
  if (computed && weights_.rows() > most_computed_functions)
    refuse(
        {"a fit of computed functions can have at most ", most_computed_functions, " functions, not ", basis_.size()});
  float_weights_ = to_float(three_columns(0));
}

template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells> brdf_table fitted_brdf<Basis>::tabulate(const valid_cells& cells,
                                                                                             thread_count threads)
const {
  if constexpr (gonio::basis<Basis>)
    if (kinds_.are_wavelengths())
      return kinds_.have_colour() ? tabulate_spectra(cells, threads).colours(kinds_.light(), threads)
                                  : brdf_table(cells);
  if constexpr (row_metric<metric_type> && combinable)
    return tabulate_rows(cells, threads);
  else
    return tabulate_cells(cells, threads);
}

template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells> spectral_table
fitted_brdf<Basis>::tabulate_spectra(const valid_cells& cells, thread_count threads)
const requires basis<Basis> {
  return tabulate_by_threes(cells, kinds_.wavelengths(), [&](Eigen::Index first) {
    return fitted_brdf(basis_, three_columns(first)).tabulate(cells, threads);
  });
}

template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells> brdf_table
fitted_brdf<Basis>::tabulate_cells(const valid_cells& cells, thread_count threads)
const {
  mapped_fields field;
  if constexpr (!computed) field = mapped_field(threads);
  const auto value_at = [&](const location& at) {
    if constexpr (computed)
      return mapped_at(at);
    else
      return interpolate(
          at, [&](Eigen::Index cell) { return rgb(field(0, cell), field(1, cell), field(2, cell)); },
          rgb(0.0, 0.0, 0.0));
  };
  const bool own = cells == basis_.cells();
  brdf_table table = brdf_table::uninitialised(cells);
  for_each_index(
      cells.size(), 4096,
      [&](Eigen::Index cell) {
        const location at = own ? locate_cell(cells, cell) : locate(basis_.cells(), cells.angles(cell));
        table.set(cell, reflectance(value_at(at), at));
      },
      threads);
  return table;
}

template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells>
typename fitted_brdf<Basis>::mapped_fields fitted_brdf<Basis>::mapped_field(thread_count threads) const {
  mapped_fields field(3, basis_.cells().size());
  constexpr bool at_once = combinable_basis<Basis>;  // one row gives all three channels
  if constexpr (at_once) field = combine(basis_, three_columns(0), threads);
  for_each_index(
      basis_.cells().size(), 4096,
      [&](Eigen::Index cell) {
        if constexpr (at_once) {
          for (Eigen::Index channel = 0; channel < 3; ++channel)
            field(channel, cell) += static_cast<float>(basis_.offset(cell));
          return;
        }
        const rgb value = mapped(cell);
        for (Eigen::Index channel = 0; channel < 3; ++channel)
          field(channel, cell) = static_cast<float>(value[channel]);
      },
      threads);
  return field;
}

template <colour_basis Basis>
requires std::same_as<domain_of<Basis>, valid_cells> brdf_table
fitted_brdf<Basis>::tabulate_rows(const valid_cells& cells, thread_count threads)
const {
  const metric_type& metric = basis_.metric();
  constexpr int fields_count = 3 + metric_type::companions;
  const mapped_fields channels = mapped_field(threads);
  const auto read = [&](Eigen::Index cell, float* out) {
    std::copy_n(&channels(0, cell), 3, out);
    if constexpr (metric_type::companions > 0) std::ranges::copy(metric.companion(cell), out + 3);
  };
  brdf_table table = brdf_table::uninitialised(cells);
  upsample<fields_count, metric_type::mean>(
      basis_.cells(), read, cells,
      [&](const cell_row& row, auto& values) {
        metric.inverse_row(row, values, table.values().subspan(3 * row.first, 3 * row.count));
      },
      threads);
  return table;
}

#if defined(GONIO_COMPILED)
extern template class fitted_brdf<log_relative_pca>;
extern template class fitted_brdf<measured<log>>;
#endif

}  // namespace gonio
