#pragma once
/// Measured materials as small neural networks, 6 -> 21 -> 21 -> 3 with rectified hidden layers.
/// Sztrajman, Rainer, Ritschel and Weyrich, "Neural BRDF Representation and Importance Sampling", Computer
/// Graphics Forum 2021, https://doi.org/10.1111/cgf.14335.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace gonio {

/// A BRDF given by the 675 parameters of a network, `[W1 6x21][b1][W2 21x21][b2][W3 21x3][b3]`, matrices
/// row-major and multiplied from the right to a row vector.
///
/// The input is the half vector and the difference vector at phi_h = 0: (sin theta_h, 0, cos theta_h) and
/// (sin theta_d cos phi_d, sin theta_d sin phi_d, cos theta_d); the output y gives max(exp(y) - 1, 0) in
/// sr^-1. phi_d is folded, which makes the BRDF reciprocal. Parameters are finite.
class network_brdf {
 public:
  static constexpr std::size_t parameter_count = 675;
  static constexpr int width = 21;
  /// exp of more than this is no longer a float.
  static constexpr double largest_output = 88.0;

  using input_weights = Eigen::Matrix<float, 6, width, Eigen::RowMajor>;
  using hidden_weights = Eigen::Matrix<float, width, width, Eigen::RowMajor>;
  using output_weights = Eigen::Matrix<float, width, 3, Eigen::RowMajor>;
  template <int Size>
  using biases = Eigen::Matrix<float, 1, Size>;

  explicit network_brdf(std::span<const float, parameter_count> parameters) noexcept {
    std::ranges::copy(parameters, parameters_.begin());
  }

  [[nodiscard]] std::span<const float, parameter_count> parameters() const noexcept { return parameters_; }
  [[nodiscard]] Eigen::Map<const input_weights> w1() const noexcept { return at<input_weights>(0); }
  [[nodiscard]] Eigen::Map<const biases<width>> b1() const noexcept { return at<biases<width>>(126); }
  [[nodiscard]] Eigen::Map<const hidden_weights> w2() const noexcept { return at<hidden_weights>(147); }
  [[nodiscard]] Eigen::Map<const biases<width>> b2() const noexcept { return at<biases<width>>(588); }
  [[nodiscard]] Eigen::Map<const output_weights> w3() const noexcept { return at<output_weights>(609); }
  [[nodiscard]] Eigen::Map<const biases<3>> b3() const noexcept { return at<biases<3>>(672); }

  /// Reflectance in sr^-1 from float weights in double arithmetic; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const half_difference angles = to_half_difference(wi, wo);
    const direction h = spherical_direction(angles.theta_h, 0.0);
    const direction d = spherical_direction(angles.theta_d, angles.phi_d);
    Eigen::Matrix<double, 1, 6> input;
    input << h.x(), 0.0, h.z(), d.x(), d.y(), d.z();
    using layer = Eigen::Matrix<double, 1, width>;
    const layer first = (input.lazyProduct(w1().cast<double>()) + b1().cast<double>()).cwiseMax(0.0);
    const layer second = (first.lazyProduct(w2().cast<double>()) + b2().cast<double>()).cwiseMax(0.0);
    const Eigen::RowVector3d y = second.lazyProduct(w3().cast<double>()) + b3().cast<double>();
    return y.transpose().array().unaryExpr([](double v) { return std::expm1(std::clamp(v, 0.0, largest_output)); });
  }

 private:
  template <class Matrix>
  [[nodiscard]] Eigen::Map<const Matrix> at(std::size_t offset) const noexcept {
    return Eigen::Map<const Matrix>(parameters_.data() + offset);
  }

  std::array<float, parameter_count> parameters_{};
};

static_assert(brdf<network_brdf>);

/// Networks and the names of their materials, as many of the one as of the other.
struct named_networks {
  std::vector<std::string> names;
  std::vector<network_brdf> networks;
};

namespace detail {

/// Evaluates networks at a block of cells in float: hidden layers are matrices of cells x 21, column-major,
/// so that each product runs along the cells.
class network_block {
 public:
  static constexpr Eigen::Index cells = 256;
  using layer = Eigen::Matrix<float, Eigen::Dynamic, network_brdf::width>;

  /// Computes the inputs, which all networks share.
  network_block(const valid_cells& all, block range)
      : inputs_(static_cast<Eigen::Index>(range.size()), 6),
        first_(inputs_.rows(), network_brdf::width),
        second_(inputs_.rows(), network_brdf::width),
        outputs_(inputs_.rows(), 3) {
    for (std::size_t cell = range.begin; cell < range.end; ++cell) {
      const half_difference angles = all.angles(cell);
      const direction h = spherical_direction(angles.theta_h, 0.0);
      const direction d = spherical_direction(angles.theta_d, angles.phi_d);
      Eigen::Matrix<double, 1, 6> input;
      input << h.x(), 0.0, h.z(), d.x(), d.y(), d.z();
      inputs_.row(static_cast<Eigen::Index>(cell - range.begin)) = input.cast<float>();
    }
  }

  /// Writes red, green and blue of one network into three columns.
  template <class Columns>
  void evaluate(const network_brdf& network, Columns&& columns) {
    first_.noalias() = inputs_ * network.w1();
    first_ = (first_.rowwise() + network.b1()).cwiseMax(0.0f);
    second_.noalias() = first_ * network.w2();
    second_ = (second_.rowwise() + network.b2()).cwiseMax(0.0f);
    outputs_.noalias() = second_ * network.w3();
    outputs_.rowwise() += network.b3();
    constexpr auto largest = static_cast<float>(network_brdf::largest_output);
    columns = outputs_.array().max(0.0f).min(largest).expm1().matrix();
  }

 private:
  Eigen::Matrix<float, Eigen::Dynamic, 6> inputs_;
  layer first_, second_;
  Eigen::Matrix<float, Eigen::Dynamic, 3> outputs_;
};

}  // namespace detail

/// Evaluates networks at every valid cell: `out` becomes (cells, 3 networks). Same bytes for any number of
/// threads; agrees with the networks' own double arithmetic to 1e-4 of the value or 1e-6 sr^-1.
inline void tabulate_networks(std::span<const network_brdf> networks, const valid_cells& cells, cell_matrix& out,
                              thread_count threads = {}, const progress& listener = {}) {
  out.resize(static_cast<Eigen::Index>(cells.size()), 3 * static_cast<Eigen::Index>(networks.size()));
  std::mutex reporting;
  std::size_t done = 0;
  for_each_block(
      cells.size(), detail::network_block::cells,
      [&](block range) {
        detail::network_block work(cells, range);
        const auto row = static_cast<Eigen::Index>(range.begin), rows = static_cast<Eigen::Index>(range.size());
        for (std::size_t n = 0; n < networks.size(); ++n)
          work.evaluate(networks[n], out.block(row, 3 * static_cast<Eigen::Index>(n), rows, 3));
        const std::scoped_lock lock(reporting);
        done += range.size();
        report(listener, "expanding networks", static_cast<double>(done) / static_cast<double>(cells.size()));
      },
      threads);
}

/// The tables of named networks.
[[nodiscard]] inline material_set tabulate_networks(const named_networks& materials, const valid_cells& cells,
                                                    thread_count threads = {}, const progress& listener = {}) {
  material_set tables{cells, materials.names, {}};
  tabulate_networks(materials.networks, cells, tables.values, threads, listener);
  return tables;
}

}  // namespace gonio
