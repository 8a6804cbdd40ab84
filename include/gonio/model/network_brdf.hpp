#pragma once
/// Measured materials as small neural networks, 6 -> 21 -> 21 -> 3 with rectified hidden layers. Sztrajman, Rainer,
/// Ritschel and Weyrich, "Neural BRDF Representation and Importance Sampling", Computer Graphics Forum 2021
/// (doi:10.1111/cgf.14335).

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

namespace gonio::model {

/// A BRDF given by the 675 parameters of a network, `[W1 6x21][b1][W2 21x21][b2][W3 21x3][b3]`. Matrices are row-major,
/// and a row vector is multiplied by a matrix on its right.
///
/// The input is the half vector and the difference vector at phi_h = 0: (sin theta_h, 0, cos theta_h) and (sin theta_d
/// cos phi_d, sin theta_d sin phi_d, cos theta_d). The BRDF is max(exp(y) - 1, 0) in sr^-1 for the output y. phi_d is
/// taken modulo pi, which makes the BRDF reciprocal. The parameters must be finite.
class network_brdf {
 public:
  static constexpr std::size_t parameter_count = 675;
  static constexpr std::size_t width = 21;
  /// The largest output that is used: exp of a larger one overflows float.
  static constexpr double largest_output = 88.0;

  explicit network_brdf(std::span<const float, parameter_count> parameters) noexcept {
    std::ranges::copy(parameters, parameters_.begin());
  }

  [[nodiscard]] std::span<const float, parameter_count> parameters() const noexcept { return parameters_; }
  /// Returns reflectance in sr^-1, computed in double from float weights; zero below the horizon.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const half_difference angles = to_half_difference(wi, wo);
    const direction h = spherical_direction(angles.theta_h, 0.0);
    const direction d = spherical_direction(angles.theta_d, angles.phi_d);
    const std::array<double, 6> input{h.x(), 0.0, h.z(), d.x(), d.y(), d.z()};
    const auto first = relu(affine<width>(input, first_layer));
    const auto second = relu(affine<width>(first, second_layer));
    const auto y = affine<3>(second, third_layer);
    const auto value = [](double v) { return std::expm1(std::clamp(v, 0.0, largest_output)); };
    return {value(y[0]), value(y[1]), value(y[2])};
  }

  /// Index of each layer's first weight among the parameters. A layer's biases follow its weights.
  static constexpr std::size_t first_layer = 0, second_layer = 147, third_layer = 609;

 private:
  template <std::size_t Outputs, std::size_t Inputs>
  [[nodiscard]] std::array<double, Outputs> affine(const std::array<double, Inputs>& x,
                                                   std::size_t layer) const noexcept {
    const float* weights = parameters_.data() + layer;
    const float* biases = weights + Inputs * Outputs;
    std::array<double, Outputs> y{};
    for (std::size_t o = 0; o < Outputs; ++o) y[o] = double{biases[o]};
    for (std::size_t i = 0; i < Inputs; ++i)
      for (std::size_t o = 0; o < Outputs; ++o) y[o] += x[i] * double{weights[i * Outputs + o]};
    return y;
  }

  [[nodiscard]] static std::array<double, width> relu(std::array<double, width> x) noexcept {
    for (double& value : x) value = std::max(value, 0.0);
    return x;
  }

  std::array<float, parameter_count> parameters_{};
};

static_assert(brdf<network_brdf>);

/// Networks, and for each network the name of its material.
struct named_networks {
  std::vector<std::string> names;
  std::vector<network_brdf> networks;
};

namespace detail {

/// Evaluates networks at a block of cells in float. For each unit of a layer, the values of all cells are stored
/// together, so that loops over the cells vectorise.
class network_block {
 public:
  static constexpr std::size_t cells = 256;

  /// Computes the inputs, which all networks share.
  network_block(const valid_cells& all, block range);

  /// Writes red, green and blue of a network at cell i to `out`, starting at out[stride * i].
  void evaluate(const network_brdf& network, float* out, std::size_t stride);

 private:
  template <std::size_t Units>
  using layer = std::array<std::array<float, cells>, Units>;

  template <std::size_t Inputs, std::size_t Outputs>
  static void affine(const network_brdf& network, std::size_t start, const layer<Inputs>& x,
                     layer<Outputs>& y) noexcept {
    const float* weights = network.parameters().data() + start;
    const float* biases = weights + Inputs * Outputs;
    for (std::size_t o = 0; o < Outputs; ++o) {
      y[o].fill(biases[o]);
      for (std::size_t i = 0; i < Inputs; ++i) {
        const float weight = weights[i * Outputs + o];
        for (std::size_t cell = 0; cell < cells; ++cell) y[o][cell] += weight * x[i][cell];
      }
    }
  }

  static void relu(layer<network_brdf::width>& x) noexcept {
    for (auto& unit : x)
      for (float& value : unit) value = std::max(value, 0.0f);
  }

  std::size_t count_;
  layer<6> inputs_{};
  layer<network_brdf::width> first_{}, second_{};
  layer<3> outputs_{};
};

}  // namespace detail

/// Evaluates networks at every valid cell: `out` becomes cells x (3 * networks). The bytes do not depend on the number
/// of threads. The values agree with the networks' double arithmetic to 1e-4 of the value or 1e-6 sr^-1.
void tabulate_networks(std::span<const network_brdf> networks, const valid_cells& cells, cell_matrix& out,
                       thread_count threads = {}, const progress& listener = {});

/// Returns the tables of named networks.
[[nodiscard]] material_set tabulate_networks(const named_networks& materials, const valid_cells& cells,
                                             thread_count threads = {}, const progress& listener = {});

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/network_brdf.ipp>
#endif
