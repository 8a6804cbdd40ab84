#pragma once
/// Bodies of io/materials/merl.hpp.

#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/table/brdf_table.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE std::string to_text(const grid_extents& extents) {
  return message_of({extents.theta_h, " x ", extents.theta_d, " x ", extents.phi_d});
}

GONIO_INLINE grid_extents merl_extents(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < merl_header_size)
    gonio::refuse({name, ": has ", bytes.size(), " bytes, expected at least ", merl_header_size,
                   " for the extents of a MERL table"});
  std::array<std::int32_t, 3> header{};
  std::memcpy(header.data(), bytes.data(), merl_header_size);
  const grid_extents extents{header[0], header[1], header[2]};
  for (const std::int32_t extent : header)
    if (extent < 1 || extent > 4096)
      gonio::refuse(
          {name, ": is not a MERL table, its extents are ", to_text(extents), ", expected each from 1 to 4096"});
  return extents;
}

GONIO_INLINE std::uint64_t merl_file_size(const grid_extents& extents) {
  const auto wide = [](int extent) { return static_cast<std::uint64_t>(extent); };
  return merl_header_size + 3 * sizeof(double) * wide(extents.theta_h) * wide(extents.theta_d) * wide(extents.phi_d);
}

GONIO_INLINE double merl_planes::operator()(std::size_t channel, std::size_t linear) const noexcept {
  double value = 0.0;
  std::memcpy(&value, data_ + sizeof value * (channel * cells_ + linear), sizeof value);
  return value;
}

GONIO_INLINE void refuse_cell(const std::string& name, const grid& cells, std::size_t linear, std::size_t channel,
                              double value) {
  constexpr std::array<const char*, 3> channels{"red", "green", "blue"};
  const cell_index cell = cells.cell(linear);
  gonio::refuse({name, ": ", channels[channel], " of cell (theta_h ", cell.theta_h, ", theta_d ", cell.theta_d,
                 ", phi_d ", cell.phi_d, ") is ", value, ", expected a finite number"});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE brdf_table read_merl(std::span<const std::byte> bytes, const std::string& name,
                                  const merl_options& options) {
  const grid_extents extents = detail::merl_extents(bytes, name);
  if (const std::uint64_t expected = detail::merl_file_size(extents); bytes.size() != expected)
    gonio::refuse({name, ": has ", bytes.size(), " bytes, expected ", expected, " for a MERL table of ",
                   detail::to_text(extents), " cells"});
  const detail::merl_planes planes(bytes.subspan(detail::merl_header_size), grid(extents).size());
  const table_convention convention =
      options.convention ? *options.convention
                         : infer_convention(extents, [&](std::size_t linear) { return planes.empty(linear); });

  const grid cells(extents, convention.anchor);
  const bool share = options.shared && options.shared->grid() == cells &&
                     options.shared->minimum_cosine() == convention.minimum_cosine;
  brdf_table table(share ? *options.shared : valid_cells(cells, convention.minimum_cosine));
  const std::span<float> values = table.values();
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) {
    const std::size_t linear = table.cells().linear(cell);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double value = planes(channel, linear) * merl_scale[channel];
      if (!(std::abs(value) <= double{std::numeric_limits<float>::max()}))
        detail::refuse_cell(name, cells, linear, channel, value);
      values[3 * cell + channel] = static_cast<float>(value);
    }
  }
  return table;
}

GONIO_INLINE void write_merl(const std::filesystem::path& path, const brdf_table& table) {
  const grid& cells = table.cells().grid();
  const auto [theta_h, theta_d, phi_d] = cells.extents();
  const std::array<std::int32_t, 3> header{theta_h, theta_d, phi_d};
  std::vector<double> plane(cells.size(), gonio::detail::merl_empty);
  file_writer file(path);
  file.write({reinterpret_cast<const std::byte*>(header.data()), detail::merl_header_size});
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) {
      const double value = double{table.values()[3 * cell + channel]};
      const std::size_t linear = table.cells().linear(cell);
      if (!std::isfinite(value)) detail::refuse_cell(path.string(), cells, linear, channel, value);
      plane[linear] = value / merl_scale[channel];
    }
    file.write({reinterpret_cast<const std::byte*>(plane.data()), plane.size() * sizeof(double)});
  }
  file.commit();
}

}  // namespace gonio::io
