#pragma once
/// Bodies of io/measurements/zemax_bsdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/measurements/zemax_bsdf.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/words.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE direction about_specular(double theta, double phi, double radial, double azimuth) noexcept {
  return model::detail::direction_about_specular(theta, phi, radial, azimuth);
}

GONIO_INLINE sample_set zemax_bsdf_reader::read() {
  read_header();
  return samples(read_planes());
}

GONIO_INLINE model::angle_grid zemax_bsdf_reader::read_grid() {
  read_header();
  const std::vector<plane> planes = read_planes();
  const auto kept = [](const std::vector<double>& list, const std::vector<bool>& are_new) {
    std::vector<Eigen::Index> positions;
    for (Eigen::Index i = 0; i < std::ssize(list); ++i)
      if (are_new[i]) positions.push_back(i);
    return positions;
  };
  const auto angles = [](const std::vector<double>& list, const std::vector<Eigen::Index>& positions) {
    std::vector<double> chosen;
    for (const Eigen::Index i : positions) chosen.push_back(radians(list[i]));
    return chosen;
  };
  const auto all = [&](const std::vector<double>& list) { return kept(list, std::vector<bool>(list.size(), true)); };
  const std::vector<Eigen::Index> rotations = kept(rotations_, are_new_azimuths(rotations_)),
                                  rows = kept(azimuths_, are_new_azimuths(azimuths_));
  model::angle_grid grid{angles(rotations_, rotations),
                         angles(incidences_, all(incidences_)),
                         angles(azimuths_, rows),
                         angles(radials_, all(radials_)),
                         {}};
  grid.viewer = model::viewer_angles::about_specular;
  const Eigen::Index columns = std::ssize(radials_), incidences = std::ssize(incidences_);
  for (const Eigen::Index rotation : rotations)
    for (Eigen::Index incidence = 0; incidence < incidences; ++incidence)
      for (const Eigen::Index row : rows)
        for (Eigen::Index column = 0; column < columns; ++column) {
          const Eigen::Index at =
              ((rotation * incidences + incidence) * std::ssize(azimuths_) + row) * columns + column;
          const rgb value = is_tristimulus_ ? from_xyz({planes[0][at], planes[1][at], planes[2][at]})
                                            : rgb(rgb::Constant(planes[0][at]));
          for (Eigen::Index c = 0; c < 3; ++c) grid.values.push_back(static_cast<float>(value[c]));
        }
  return grid;
}

GONIO_INLINE std::vector<zemax_bsdf_reader::plane> zemax_bsdf_reader::read_planes() {
  std::vector<plane> planes;
  if (!is_tristimulus_) {
    static_cast<void>(words_.read_one_of({"Monochrome"}));
    planes.push_back(read_plane());
  }
  for (const std::string_view channel : {"TristimulusX", "TristimulusY", "TristimulusZ"}) {
    if (!is_tristimulus_) break;
    static_cast<void>(words_.read_one_of({channel}));
    planes.push_back(read_plane());
  }
  if (const std::string_view more = words_.peek(); !more.empty())
    words_.position().refuse({in_quotes(more), " follows the data, expected the end of the file"});
  return planes;
}

GONIO_INLINE void zemax_bsdf_reader::read_header() {
  constexpr std::string_view start_of_data = "the data (Monochrome or TristimulusX)";
  const auto is_data = [](std::string_view word) { return word == "Monochrome" || word.starts_with("Tristimulus"); };
  while (!is_data(words_.peek())) {
    const std::string_view key = words_.read(start_of_data);
    if (key == "Source" || key == "Symmetry")
      static_cast<void>(words_.read(key));  // ignored: the list of azimuths shows the measured directions
    else if (key == "SpectralContent")
      is_tristimulus_ = words_.read_one_of({"Monochrome", "XYZ"}) == 1;
    else if (key == "ScatterType")
      read_scatter_type();
    else if (key == "SampleRotation")
      rotations_ = words_.read_list("SampleRotation", -360.0, 360.0);
    else if (key == "AngleOfIncidence")
      incidences_ = words_.read_list("AngleOfIncidence", 0.0, 90.0);
    else if (key == "ScatterAzimuth")
      azimuths_ = words_.read_list("ScatterAzimuth", -360.0, 360.0);
    else if (key == "ScatterRadial")
      radials_ = words_.read_list("ScatterRadial", 0.0, 180.0);
    else
      words_.position().refuse({in_quotes(key), " is not a keyword of a Zemax BSDF file"});
  }
  require_lists();
}

GONIO_INLINE void zemax_bsdf_reader::read_scatter_type() {
  if (words_.read_one_of({"BRDF", "BTDF"}) == 1)
    words_.position().refuse("the file holds transmission (BTDF), expected a BRDF");
}

GONIO_INLINE void zemax_bsdf_reader::require_lists() const {
  const auto require = [this](const std::vector<double>& list, std::string_view keyword) {
    if (list.empty()) gonio::refuse({words_.position().name, ": ", keyword, " is missing before the data"});
  };
  require(rotations_, "SampleRotation");
  require(incidences_, "AngleOfIncidence");
  require(azimuths_, "ScatterAzimuth");
  require(radials_, "ScatterRadial");
}

GONIO_INLINE zemax_bsdf_reader::plane zemax_bsdf_reader::read_plane() {
  words_.read_if("DataBegin");
  plane values;
  for (std::size_t block = 0; block < rotations_.size() * incidences_.size(); ++block) {
    static_cast<void>(words_.read_one_of({"TIS"}));
    static_cast<void>(words_.read_number("TIS"));
    for (std::size_t i = 0; i < azimuths_.size() * radials_.size(); ++i) {
      values.push_back(words_.read_number("BRDF"));
      require_float_range(values.back(), words_.position());
    }
  }
  words_.read_if("DataEnd");
  return values;
}

GONIO_INLINE sample_set zemax_bsdf_reader::samples(const std::vector<plane>& planes) const {
  const std::vector<bool> are_new = are_new_azimuths(azimuths_), are_new_rotations = are_new_azimuths(rotations_);
  const std::size_t columns = radials_.size(), block = azimuths_.size() * columns;
  std::array<double, 3> values{};
  sample_collector collector = is_tristimulus_ ? sample_collector::of_xyz() : sample_collector();
  for (std::size_t b = 0; b < rotations_.size() * incidences_.size(); ++b) {
    if (!are_new_rotations[b / incidences_.size()]) continue;
    const double theta = radians(incidences_[b % incidences_.size()]);
    const double phi = radians(rotations_[b / incidences_.size()]);
    for (std::size_t row = 0; row < azimuths_.size(); ++row)
      for (std::size_t column = 0; column < columns; ++column) {
        const double radial = radians(radials_[column]);
        if (!are_new[row] || (radial == 0.0 && row > 0)) continue;  // every row contains the specular direction
        for (std::size_t c = 0; c < planes.size(); ++c) values[c] = planes[c][b * block + row * columns + column];
        const direction wo = about_specular(theta, phi, radial, radians(azimuths_[row]));
        collector.add({spherical_direction(theta, phi), wo}, {values.data(), collector.channel_count()});
      }
  }
  return std::move(collector).samples(words_.position().name);
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_zemax_bsdf(std::string_view text) {
  text_position position;
  const std::string_view first = detail::word_reader(text, position).peek();
  return first == "Source" || first == "Symmetry" || first == "SpectralContent" || first == "ScatterType";
}

GONIO_INLINE sample_set read_zemax_bsdf(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  return detail::zemax_bsdf_reader(text, position).read();
}

GONIO_INLINE sample_set read_zemax_bsdf(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_zemax_bsdf(as_text(bytes), path.string());
}

}  // namespace gonio::io
