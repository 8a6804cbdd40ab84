#pragma once
/// Measurements in the surface scattering distribution data format, version 0.3: Kimura Ryo, "Surface scattering
/// distribution data (SSDD) file format" (github.com/KimuraRyo/libbsdf, doc/SsddFileFormatSpecification.md), which
/// BSDFProcessor writes. A text header, then a block for each of BRDF, BTDF and specular parts: lists of four angles in
/// degrees, and a colour for each of their combinations, as text or in binary (float32, little-endian, as libbsdf).

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

/// Reads such a file block by block.
class ssdd_reader {
 public:
  ssdd_reader(std::string_view text, text_place& place) : words_(text, place) {}

  [[nodiscard]] sample_collector read();

 private:
  enum class coordinates { spherical, specular, half_difference, distorted_spherical };

  /// What stands before a block's numbers.
  struct block_header {
    std::string_view type, colour_model;
    std::optional<coordinates> parameters;
    std::vector<double> wavelengths;
    std::array<std::vector<double>, 4> angles;  ///< degrees; without azimuths of incidence there is one, 0
  };

  void read_header();
  [[nodiscard]] block_header read_block_header();
  void read_entry(block_header& block, std::string_view key);
  [[nodiscard]] std::size_t channel_count(const block_header& block) const;
  void check_block(const block_header& block) const;
  /// The numbers of `count` colours.
  [[nodiscard]] std::vector<double> read_numbers(std::size_t count);
  void read_block();
  [[nodiscard]] sample_collector collector_of(const block_header& block) const;
  [[nodiscard]] sample_collector samples(const block_header& block, const std::vector<double>& numbers) const;
  [[nodiscard]] static direction_pair pair_of(coordinates parameters, const std::array<double, 4>& angles);

  word_reader words_;
  std::optional<sample_collector> samples_;
};

}  // namespace detail

/// Does the text begin as such a file does?
[[nodiscard]] bool looks_like_ssdd(std::string_view text);

/// Samples of the BRDF in the text of such a file; other blocks are passed over, `name` is what errors call it. Colours
/// are grey, linear RGB (the format does not say which; Rec. 709 is assumed), CIE XYZ (D65) or spectra. Of a table that
/// is reduced by symmetry or reciprocity the part that is there is read. A direction that the table has more than once
/// is one sample; those at the horizon are none. Throws gonio::error naming the line of what is wrong, also for
/// distorted spherical coordinates and offsets, which the specification does not define in full.
[[nodiscard]] sample_set read_ssdd(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_ssdd(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/ssdd.ipp>
#endif
