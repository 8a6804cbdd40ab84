#pragma once
/// Measurements in the surface scattering distribution data format, version 0.3: Kimura Ryo, "Surface scattering
/// distribution data (SSDD) file format" (github.com/KimuraRyo/libbsdf, doc/SsddFileFormatSpecification.md), written by
/// BSDFProcessor. A text header, then a block for each of BRDF, BTDF and specular parts: lists of four angles in
/// degrees, and a colour for each combination, as text or binary (float32, little-endian, as in libbsdf).

#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/words.hpp>
#include <gonio/table/sample_set.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

namespace detail {

/// Reads a file block by block.
class ssdd_reader {
 public:
  ssdd_reader(std::string_view text, text_position& position) : words_(text, position) {}

  [[nodiscard]] sample_collector read();

 private:
  enum class coordinates { spherical, specular, half_difference, distorted_spherical };

  /// The header of a block.
  struct block_header {
    std::string_view type, colour_model;
    std::optional<coordinates> parameters;
    std::vector<double> wavelengths;
    std::array<std::vector<double>, 4> angles;  ///< degrees; if azimuths of incidence are missing, the azimuth is 0
  };

  void read_header();
  [[nodiscard]] block_header read_block_header();
  void read_entry(block_header& block, std::string_view key);
  [[nodiscard]] std::size_t channel_count(const block_header& block) const;
  void check_block(const block_header& block) const;
  /// Reads `count` numbers, as text or binary.
  [[nodiscard]] std::vector<double> read_numbers(std::size_t count);
  void read_block();
  [[nodiscard]] sample_collector collector_of(const block_header& block) const;
  [[nodiscard]] sample_collector samples(const block_header& block, const std::vector<double>& numbers) const;
  [[nodiscard]] static direction_pair pair_of(coordinates parameters, const std::array<double, 4>& angles);

  word_reader words_;
  std::optional<sample_collector> samples_;
};

}  // namespace detail

/// Does the text begin like an SSDD file?
[[nodiscard]] bool looks_like_ssdd(std::string_view text);

/// Reads samples of the BRDF from the text of an SSDD file; skips other blocks. Colours are grey, linear RGB (assumed
/// to be Rec. 709, because the format does not say), CIE XYZ (D65) or spectra. If a table is reduced by symmetry or
/// reciprocity, only its stored part is read. A direction that occurs more than once gives one sample; directions at
/// the horizon are skipped. Throws gonio::error naming the faulty line, and for distorted spherical coordinates and
/// offsets, which the specification does not fully define. Errors call the file `name`.
[[nodiscard]] sample_set read_ssdd(std::string_view text, const std::string& name);

/// Reads an SSDD file.
[[nodiscard]] sample_set read_ssdd(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/ssdd.ipp>
#endif
