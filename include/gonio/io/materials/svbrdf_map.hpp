#pragma once
/// Maps of spatially varying BRDFs (.gsv): for each texel of an image the weights of functions, each a combination of a
/// prior's components, as half floats, its uncertainty and its disagreement (texels/texel_decomposition.hpp), in
/// bands of whole rows, each with its checksum. Of any size: neither who writes nor who reads needs more than a band in
/// memory. The format is described in docs/reference/formats.md. POSIX.

#include <gonio/basis/pca.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/texels/texel_decomposition.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// A number that tells priors apart: the CRC-32 of their components, mean and reference. O(cells x components).
[[nodiscard]] std::uint32_t checksum_of(const log_relative_pca& prior);

/// What a map is of, and how its file is laid out: all offsets follow from it.
struct svbrdf_header {
  Eigen::Index rows = 0, columns = 0;      ///< texels
  Eigen::Index band_rows = 0;              ///< rows of texels in a band; the last band may have fewer
  double eta = 0.0;                        ///< Tikhonov's penalty
  std::uint32_t prior_checksum = 0;        ///< `checksum_of` the prior
  std::string prior_source;                ///< what the prior was learned from, for people
  std::vector<direction_pair> directions;  ///< in which the texels were measured
  Eigen::MatrixXf functions;  ///< V, k x r: V times a texel's weights are the weights of the prior's k components

  [[nodiscard]] Eigen::Index bands() const noexcept { return (rows + band_rows - 1) / band_rows; }
  [[nodiscard]] Eigen::Index texels_of_band(Eigen::Index band) const noexcept {
    return columns * std::min(band_rows, rows - band * band_rows);
  }
};

/// A number that tells headers apart: the CRC-32 that the file has of its header.
[[nodiscard]] std::uint32_t checksum_of(const svbrdf_header& header);

/// Rows of a band such that about 16,384 texels are in memory at a time.
[[nodiscard]] Eigen::Index rows_of_band(Eigen::Index columns) noexcept;

/// A band's numbers as half floats, as the file has them.
struct svbrdf_band {
  std::vector<std::uint16_t> weights;                    ///< texels x 3 x r: the weights of red, of green, of blue
  std::vector<std::uint16_t> uncertainty, disagreement;  ///< texels

  /// Is a texel of the sample? The others have zeros throughout.
  [[nodiscard]] bool has_material(Eigen::Index texel) const { return uncertainty.at(texel) != 0; }
};

/// Each number rounded to 11 bits. A texel whose uncertainty is not zero is of the sample: neither its uncertainty nor
/// all of its weights are rounded to zero. Throws gonio::error if a number is beyond the range of half floats.
[[nodiscard]] svbrdf_band as_halves(const texel_estimates& found, thread_count threads = {});

/// A band as the file has it, its checksum at the end. Throws gonio::error unless it has as many numbers as the header
/// asks for.
[[nodiscard]] std::vector<std::byte> write_band(const svbrdf_header& header, Eigen::Index band,
                                                const svbrdf_band& values);

/// Writes a map band by band into `PATH.part`, which becomes PATH when it is whole. A job whose process ended goes on
/// behind its last whole band: the same job makes the same bytes, however often it is interrupted. One process at a
/// time can have it open.
class svbrdf_writer {
 public:
  /// Throws gonio::error if an unfinished file is there that is of another job (its header differs), is open in another
  /// process or cannot be written, or if the header is impossible. The file is then as it was.
  svbrdf_writer(const std::filesystem::path& path, const svbrdf_header& header);

  /// Bands that are written already, by this process or one before.
  [[nodiscard]] Eigen::Index finished() const noexcept { return finished_; }

  /// Are the bytes of a finished band these? Tells whether a job that goes on has the images that it began with.
  [[nodiscard]] bool has_written(Eigen::Index band, std::span<const std::byte> bytes) const;

  /// The next band. Throws gonio::error if it cannot be stored, as on a full disk: what was written before stays.
  void append(const svbrdf_band& values);
  /// The next band as `write_band` has made it, maybe elsewhere. Throws gonio::error, too, if it was damaged since.
  void append(std::span<const std::byte> bytes);

  /// Gives the file its name once all bands are there, and are on the disk.
  void commit();

 private:
  void open();
  void resume(std::span<const std::byte> head);
  void require_unfinished() const;
  void write(std::span<const std::byte> bytes);
  [[noreturn]] void fail() const;

  std::filesystem::path path_, target_, part_;
  svbrdf_header header_;
  descriptor file_;
  std::uint64_t head_size_ = 0;
  Eigen::Index finished_ = 0;
};

/// A whole map, read band by band. May be read by any number of threads.
class svbrdf_map {
 public:
  /// Reads the header. Throws gonio::error if the file is no map, of another version, damaged, or has not the size that
  /// its header asks for.
  explicit svbrdf_map(const std::filesystem::path& path);

  [[nodiscard]] const svbrdf_header& header() const noexcept { return header_; }

  /// Throws gonio::error if the band is damaged (checksum), or there is none of this number.
  [[nodiscard]] svbrdf_band read_band(Eigen::Index band) const;

  /// Throws gonio::error unless the map is of this prior.
  void require_prior(const log_relative_pca& prior) const;

 private:
  std::filesystem::path path_;
  svbrdf_header header_;
  descriptor file_;
  std::uint64_t head_size_ = 0;
};

/// Does the file start as a map does?
[[nodiscard]] bool is_svbrdf_map(const std::filesystem::path& path);

/// The weights of the prior's components of a texel of a band, k x 3, for `render::component_brdf` and `fitted_brdf`;
/// zeros if it is not of the sample.
[[nodiscard]] Eigen::MatrixXd weights_of_texel(const svbrdf_header& header, const svbrdf_band& band,
                                               Eigen::Index texel);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/svbrdf_map.ipp>
#endif
