#pragma once
/// Bodies of io/materials/utia.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/materials/utia.hpp>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Calls `visit(node, number)` for each pair of directions: its node in the grid, and its number in a plane of the
/// file.
template <class Visit>
void for_each_utia_pair(const utia_directions& directions, const Visit& visit) {
  const Eigen::Index polar = directions.polar, azimuths = directions.azimuths;
  Eigen::Index node = 0;
  for (Eigen::Index phi_i = 0; phi_i < azimuths; ++phi_i)
    for (Eigen::Index theta_i = 0; theta_i < polar; ++theta_i)
      for (Eigen::Index phi_o = 0; phi_o < azimuths; ++phi_o)
        for (Eigen::Index theta_o = 0; theta_o < polar; ++theta_o)
          visit(node++, ((theta_i * azimuths + phi_i) * polar + theta_o) * azimuths + phi_o);
}

template <class Number>
[[nodiscard]] std::vector<float> utia_values(std::span<const std::byte> bytes, const std::string& name,
                                             const utia_directions& directions) {
  const std::vector<Number> planes = byte_reader(bytes, name).read_all<Number>(bytes.size() / sizeof(Number));
  std::vector<float> values(planes.size());
  const Eigen::Index plane = directions.size();
  for_each_utia_pair(directions, [&](Eigen::Index node, Eigen::Index number) {
    for (Eigen::Index c = 0; c < 3; ++c) values[3 * node + c] = static_cast<float>(planes[c * plane + number]);
  });
  return values;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE model::angle_grid utia_grid(const utia_directions& directions) {
  const auto [polar, polar_step, azimuths] = directions;
  if (polar < 2 || polar > 360 || azimuths < 3 || azimuths > 720 || !(polar_step > 0.0) ||
      !(polar_step * static_cast<double>(polar - 1) <= 90.0))
    gonio::refuse({"a file of UTIA's database needs from 2 to 360 polar angles up to 90 degrees and from 3 to 720 ",
                   "azimuths, not ", polar, " in steps of ", polar_step, " degrees and ", azimuths});
  model::angle_grid grid;
  for (Eigen::Index i = 0; i < polar; ++i) grid.theta_i.push_back(radians(polar_step * static_cast<double>(i)));
  for (Eigen::Index i = 0; i < azimuths; ++i)
    grid.phi_i.push_back(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(azimuths));
  grid.viewer_polar = grid.theta_i;
  grid.viewer_azimuth = grid.phi_i;
  grid.beyond = model::beyond_grid::extrapolated;
  return grid;
}

GONIO_INLINE model::angle_grid_brdf read_utia(std::span<const std::byte> bytes, const std::string& name,
                                              const utia_directions& directions) {
  model::angle_grid grid = utia_grid(directions);
  const std::size_t numbers = 3 * static_cast<std::size_t>(directions.size());
  if (bytes.size() != numbers * sizeof(double) && bytes.size() != numbers * sizeof(float))
    gonio::refuse({name, ": has ", bytes.size(), " bytes, expected three planes of ",
                   directions.polar * directions.azimuths, " x ", directions.polar * directions.azimuths,
                   " float64 or float32 numbers"});
  grid.values = bytes.size() == numbers * sizeof(double) ? detail::utia_values<double>(bytes, name, directions)
                                                         : detail::utia_values<float>(bytes, name, directions);
  try {
    return model::angle_grid_brdf(std::move(grid));
  } catch (const error& why) {
    gonio::refuse({name, ": ", why.what()});
  }
}

GONIO_INLINE std::vector<std::byte> write_utia(const model::angle_grid& grid, const utia_directions& directions) {
  const model::angle_grid expected = utia_grid(directions);
  if (grid.phi_i != expected.phi_i || grid.theta_i != expected.theta_i || grid.viewer_polar != expected.viewer_polar ||
      grid.viewer_azimuth != expected.viewer_azimuth || grid.viewer != expected.viewer ||
      std::ssize(grid.values) != 3 * grid.size())
    gonio::refuse("the grid does not have the directions of a file of UTIA's database");
  std::vector<double> planes(grid.values.size());
  detail::for_each_utia_pair(directions, [&](Eigen::Index node, Eigen::Index number) {
    for (Eigen::Index c = 0; c < 3; ++c) planes[c * directions.size() + number] = double{grid.values[3 * node + c]};
  });
  byte_writer writer;
  writer.write_all(std::span<const double>(planes));
  return std::move(writer).bytes();
}

}  // namespace gonio::io
