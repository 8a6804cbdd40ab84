#include "viewer_table.hpp"

#include <gonio/core/error.hpp>
#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/text/base64.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cli {

namespace {

constexpr int dropped_bits = 2;

/// Returns the bits of a half float without the last two, rounded. As integers, the bits increase with the value.
int code_of(double value) {
  const auto bits = std::bit_cast<std::uint16_t>(Eigen::half(static_cast<float>(std::max(value, 0.0))));
  return (bits + (1 << (dropped_bits - 1))) >> dropped_bits;
}

/// Returns the power of two that brings the largest value to at most 32768, which a half float can hold.
double scale_of(std::span<const float> values) {
  const double largest = *std::ranges::max_element(values);
  return largest > 0.0 ? std::exp2(std::ceil(std::log2(largest)) - 15.0) : 1.0;
}

json size_of(const gonio::grid& cells) {
  const auto [theta_h, theta_d, phi_d] = cells.extents();
  return {theta_h, theta_d, phi_d};
}

/// Compresses with level 6: level 9 takes fourteen times as long for 5 % fewer bytes.
json packed(const std::vector<std::byte>& bytes) { return gonio::io::base64(gonio::io::compress_bytes(bytes, 6)); }

}  // namespace

json viewer_table(const gonio::brdf_table& table) {
  const gonio::valid_cells& cells = table.cells();
  const std::span<const float> values = table.values();
  if (!std::ranges::all_of(values, [](float value) { return std::isfinite(value); }))
    gonio::refuse("the table for the viewer has values that are not finite");
  const double scale = scale_of(values);
  // Store the low bytes of all differences, then the high bytes, which are nearly all zero.
  const std::size_t count = values.size();
  std::vector<std::byte> bytes(2 * count);
  std::size_t next = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    int before = 0;
    for (std::size_t i = channel; i < count; i += 3, ++next) {
      const int code = code_of(values[i] / scale), difference = code - before;
      const int folded = difference >= 0 ? 2 * difference : -2 * difference - 1;  // folds the sign
      bytes[next] = static_cast<std::byte>(folded & 255);
      bytes[count + next] = static_cast<std::byte>(folded >> 8);
      before = code;
    }
  }
  return {{"grid", size_of(cells.grid())},
          {"offset", cells.grid().anchor() == gonio::cell_anchor::centre ? 0.5 : 0.0},
          {"minimum_cosine", std::max(cells.minimum_cosine(), gonio::valid_cells::horizon)},
          {"cells", cells.size()},
          {"scale", scale},
          {"codes", packed(bytes)}};
}

json viewer_uncertainty(const gonio::brdf_table& relative) {
  const gonio::grid_extents fine = relative.cells().grid().extents();
  const auto half = [](int extent) { return (extent + 1) / 2; };
  const gonio::grid coarse({half(fine.theta_h), half(fine.theta_d), half(fine.phi_d)}, gonio::cell_anchor::centre);
  std::vector<std::byte> bytes(coarse.size());
  for (Eigen::Index i = 0; i < coarse.size(); ++i) {
    const double value = relative.at(gonio::locate(relative.cells(), coarse.angles(coarse.cell(i)))).y();
    const double step = 255.0 / 4.0 * std::log10(std::max(value, 1e-9) / 1e-3);
    bytes[i] = static_cast<std::byte>(static_cast<int>(std::clamp(std::round(step), 0.0, 255.0)));
  }
  return {{"grid", size_of(coarse)}, {"codes", packed(bytes)}};
}

}  // namespace cli
