#pragma once
/// Measurements in Zemax's tabular BSDF format, also written by imaging spheres (IS-SA): R. Rykowski, "Zemax Tabular
/// BSDF data file format", support.zemax.com/hc/en-us/articles/1500005486801 (first as "BSDF Data Interchange file
/// format specification", 2008). A file has a block of rows for each rotation of the sample and angle of incidence.
/// Rows are azimuths and columns radial angles **about the specular direction**: radial 0 is the specular direction,
/// azimuth 0 points from it towards the normal, azimuths go counterclockwise seen from outside (as in libbsdf by Kimura
/// Ryo, github.com/KimuraRyo/libbsdf). Values are sr^-1 without the cosine, grey or CIE XYZ.

#include <gonio/io/text/words.hpp>
#include <gonio/model/angle_grid_brdf.hpp>
#include <gonio/table/sample_set.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

namespace detail {

/// Reads a file word by word.
class zemax_bsdf_reader {
 public:
  zemax_bsdf_reader(std::string_view text, text_position& position) : words_(text, position) {}

  /// Returns the samples.
  [[nodiscard]] sample_set read();
  /// Returns all nodes; an azimuth or rotation that occurs twice (0 and 360) is returned once.
  [[nodiscard]] model::angle_grid read_grid();

 private:
  /// One channel's numbers in the file's order: rotations, angles of incidence, azimuths, radial angles.
  using plane = std::vector<double>;

  void read_header();
  [[nodiscard]] std::vector<plane> read_planes();
  void read_scatter_type();
  void require_lists() const;
  [[nodiscard]] plane read_plane();
  [[nodiscard]] sample_set samples(const std::vector<plane>& planes) const;

  word_reader words_;
  bool is_tristimulus_ = false;
  std::vector<double> rotations_, incidences_, azimuths_, radials_;  ///< degrees
};

/// Returns the direction at a radial angle and azimuth about the specular direction of light at (theta, phi), radians.
[[nodiscard]] direction about_specular(double theta, double phi, double radial, double azimuth) noexcept;

}  // namespace detail

/// Does the text begin like a Zemax BSDF file?
[[nodiscard]] bool looks_like_zemax_bsdf(std::string_view text);

/// Reads samples from the text of a Zemax BSDF file. A direction that occurs more than once (radial 0, azimuths or
/// rotations 0 and 360) gives one sample; directions at or below the horizon are skipped. If a table has only half of
/// the azimuths because of symmetry about the plane of incidence, only that half is read. Throws gonio::error naming
/// the faulty line, and for files of transmission. Errors call the file `name`.
[[nodiscard]] sample_set read_zemax_bsdf(std::string_view text, const std::string& name);

/// Reads a Zemax BSDF file.
[[nodiscard]] sample_set read_zemax_bsdf(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/zemax_bsdf.ipp>
#endif
