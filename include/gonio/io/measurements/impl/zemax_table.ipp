#pragma once
/// Bodies of io/measurements/zemax_table.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/zemax_bsdf.hpp>
#include <gonio/io/measurements/zemax_table.hpp>
#include <gonio/io/text/text.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Returns CIE XYZ of each node, 0 below the horizon.
[[nodiscard]] inline std::vector<rgb> tristimuli_of(const model::angle_grid& grid) {
  std::vector<rgb> all(static_cast<std::size_t>(grid.size()), rgb::Zero());
  for (Eigen::Index node = 0; node < grid.size(); ++node) {
    if (!(model::directions_of(grid, node).wo.z() > 0.0)) continue;
    const float* value = grid.values.data() + 3 * node;
    all[node] = to_xyz({value[0], value[1], value[2]});
  }
  return all;
}

/// Returns the weight of each node of an axis in the trapezoidal rule. An azimuth that covers a full turn is periodic.
[[nodiscard]] inline std::vector<double> trapezoids(const std::vector<double>& nodes, bool is_azimuth) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const std::size_t count = nodes.size();
  std::vector<double> weights(count, is_azimuth && count == 1 ? turn : 0.0);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double half = 0.5 * (nodes[i + 1] - nodes[i]);
    weights[i] += half;
    weights[i + 1] += half;
  }
  if (!is_azimuth || count == 1) return weights;
  if (nodes.back() - nodes.front() <= 0.5 * turn + 1e-9) {  // the other side is its mirror image
    for (double& weight : weights) weight *= 2.0;
    return weights;
  }
  const double half = 0.5 * (nodes.front() + turn - nodes.back());
  weights.front() += half;
  weights.back() += half;
  return weights;
}

/// The text of one plane: blocks of rows for each rotation and angle of incidence.
class zemax_plane_writer {
 public:
  zemax_plane_writer(const model::angle_grid& grid, const std::vector<rgb>& values)
      : grid_(grid),
        values_(values),
        around_(trapezoids(grid.viewer_azimuth, true)),
        outwards_(trapezoids(grid.viewer_polar, false)) {}

  [[nodiscard]] std::string text(Eigen::Index channel) const {
    const Eigen::Index columns = std::ssize(grid_.viewer_polar), rows = std::ssize(grid_.viewer_azimuth);
    std::string all;
    for (Eigen::Index block = 0; block < grid_.size() / columns / rows; ++block) {
      all += "TIS " + number(scattered(block * rows * columns, channel)) + '\n';
      for (Eigen::Index row = 0; row < rows; ++row)
        for (Eigen::Index column = 0; column < columns; ++column)
          all +=
              number(values_[(block * rows + row) * columns + column][channel]) + (column + 1 < columns ? ' ' : '\n');
    }
    return all;
  }

 private:
  /// Returns a number in six digits.
  [[nodiscard]] static std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
  }

  /// Returns the total integrated scatter of the block that begins at a node: its integral with the cosine.
  [[nodiscard]] double scattered(Eigen::Index first, Eigen::Index channel) const {
    const Eigen::Index columns = std::ssize(outwards_);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < columns * std::ssize(around_); ++i) {
      const double cosine = model::directions_of(grid_, first + i).wo.z();
      if (cosine > 0.0)
        sum += values_[first + i][channel] * cosine * std::sin(grid_.viewer_polar[i % columns]) *
               outwards_[i % columns] * around_[i / columns];
    }
    return sum;
  }

  const model::angle_grid& grid_;
  const std::vector<rgb>& values_;
  std::vector<double> around_, outwards_;
};

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE model::angle_grid_brdf read_zemax_table(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  try {
    return model::angle_grid_brdf(detail::zemax_bsdf_reader(text, position).read_grid());
  } catch (const error& why) {
    const std::string_view what = why.what();
    gonio::refuse({what.starts_with(name) ? "" : name + ": ", what});
  }
}

GONIO_INLINE model::angle_grid_brdf read_zemax_table(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_zemax_table(as_text(bytes), path.string());
}

GONIO_INLINE model::angle_grid zemax_grid(const zemax_resolution& resolution) {
  const auto [rotations, incidences, azimuths, radials] = resolution;
  for (const Eigen::Index count : {rotations + 1, incidences, azimuths, radials})
    if (count < 2 || count > 361)
      gonio::refuse({"a table of Zemax needs from 1 to 360 rotations and from 2 to 360 other angles, not ", rotations,
                     ", ", incidences, ", ", azimuths, " and ", radials});
  constexpr double turn = 2.0 * std::numbers::pi, widest = radians(175.0), steepest = radians(85.0);
  const auto share = [](Eigen::Index i, Eigen::Index count) {
    return static_cast<double>(i) / static_cast<double>(count);
  };
  model::angle_grid grid;
  grid.viewer = model::viewer_angles::about_specular;
  for (Eigen::Index i = 0; i < rotations; ++i) grid.phi_i.push_back(turn * share(i, rotations));
  for (Eigen::Index i = 0; i < incidences; ++i) grid.theta_i.push_back(steepest * share(i, incidences - 1));
  const Eigen::Index rows = rotations == 1 ? azimuths / 2 + 1 : azimuths;
  for (Eigen::Index i = 0; i < rows; ++i)
    grid.viewer_azimuth.push_back(rotations == 1 ? 0.5 * turn * share(i, rows - 1) : turn * share(i, rows));
  for (Eigen::Index i = 0; i < radials; ++i) {
    const double along = share(i, radials - 1);
    grid.viewer_polar.push_back(radians(std::round(1e3 * degrees(widest * along * along)) / 1e3));
  }
  return grid;
}

GONIO_INLINE std::string write_zemax_table(const model::angle_grid& grid, const std::string& comment) {
  if (grid.viewer != model::viewer_angles::about_specular || std::ssize(grid.values) != 3 * grid.size())
    gonio::refuse("a table of Zemax needs a grid about the specular direction, with three values a node");
  const auto list = [](std::string_view keyword, const std::vector<double>& angles) {
    std::string text = message_of({keyword, " ", angles.size(), "\n"});
    for (const double angle : angles) text += shortest(std::round(1e6 * degrees(angle)) / 1e6) + ' ';
    text.back() = '\n';
    return text;
  };
  std::string text = "# " + printable(comment) + "\nSource Measured\nSymmetry ";
  text += grid.phi_i.size() > 1 ? "ASymmetrical4D" : "PlaneSymmetrical";
  text += "\nSpectralContent XYZ\nScatterType BRDF\n";
  text += list("SampleRotation", grid.phi_i) + list("AngleOfIncidence", grid.theta_i) +
          list("ScatterAzimuth", grid.viewer_azimuth) + list("ScatterRadial", grid.viewer_polar);
  const std::vector<rgb> values = detail::tristimuli_of(grid);
  const detail::zemax_plane_writer planes(grid, values);
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    text += "\nTristimulus";
    text += "XYZ"[channel];
    text += "\nDataBegin\n" + planes.text(channel) + "DataEnd\n";
  }
  return text;
}

GONIO_INLINE void write_zemax_table(const std::filesystem::path& path, const model::angle_grid& grid,
                                    const std::string& comment) {
  const std::string text = write_zemax_table(grid, comment);
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace gonio::io
