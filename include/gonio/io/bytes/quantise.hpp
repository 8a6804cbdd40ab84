#pragma once
/// Quantised columns of numbers, delta-coded so that deflate can exploit the smoothness of a BRDF along phi_d.

#include <gonio/io/bytes/byte_stream.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace gonio::io {

/// A column as unsigned codes between its smallest and largest value: value = low + code * step. The error is at most
/// step / 2.
template <std::unsigned_integral Code>
struct quantised {
  float low = 0.0f;
  float step = 0.0f;
  std::vector<Code> codes;
};

/// Quantises finite values linearly between the smallest and the largest.
template <std::unsigned_integral Code>
[[nodiscard]] quantised<Code> quantise(std::span<const float> values) {
  if (values.empty()) return {};
  float low = values[0], high = values[0];
  for (const float value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double step = (double{high} - double{low}) / std::numeric_limits<Code>::max();
  quantised<Code> result{low, static_cast<float>(step), std::vector<Code>(values.size())};
  // The reader multiplies by the stored float step, not by the exact one.
  const double stored = result.step;
  constexpr double most = std::numeric_limits<Code>::max();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double code = stored > 0.0 ? std::round((double{values[i]} - double{low}) / stored) : 0.0;
    result.codes[i] = static_cast<Code>(std::clamp(code, 0.0, most));
  }
  return result;
}

template <std::unsigned_integral Code>
[[nodiscard]] float dequantise(const quantised<Code>& column, std::size_t i) {
  return static_cast<float>(double{column.low} + static_cast<double>(column.codes[i]) * double{column.step});
}

/// Writes low, step, and the differences of successive codes modulo the code's range: first the most significant byte
/// of each difference, last the least significant.
template <std::unsigned_integral Code>
void write_quantised(byte_writer& out, const quantised<Code>& column) {
  out.write(column.low);
  out.write(column.step);
  std::vector<std::uint8_t> plane(column.codes.size());
  for (int shift = 8 * (static_cast<int>(sizeof(Code)) - 1); shift >= 0; shift -= 8) {
    Code previous = 0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
      plane[i] = static_cast<std::uint8_t>(static_cast<Code>(column.codes[i] - previous) >> shift);
      previous = column.codes[i];
    }
    out.write_bytes(plane.data(), plane.size());
  }
}

template <std::unsigned_integral Code>
[[nodiscard]] quantised<Code> read_quantised(byte_reader& in, std::size_t count) {
  quantised<Code> column{in.read<float>(), in.read<float>(), std::vector<Code>(count)};
  for (std::size_t byte = 0; byte < sizeof(Code); ++byte) {
    const auto plane = in.read_all<std::uint8_t>(count);
    for (std::size_t i = 0; i < count; ++i) column.codes[i] = static_cast<Code>((column.codes[i] << 8) | plane[i]);
  }
  Code value = 0;
  for (Code& code : column.codes) code = value = static_cast<Code>(value + code);
  return column;
}

}  // namespace gonio::io
