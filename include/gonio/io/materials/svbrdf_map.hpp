#pragma once
/// Maps of spatially varying BRDFs (.gsv). For each texel of an image, a map holds half floats: its uncertainty, its
/// disagreement (texels/texel_decomposition.hpp), and its weights of functions that combine a prior's components. The
/// map is stored in bands of whole rows, each with its checksum: writers and readers need only one band in memory.
/// docs/reference/formats.md describes the format. POSIX only.

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

/// Returns a number that identifies a prior: the CRC-32 of its components, mean and reference. O(cells x components).
[[nodiscard]] std::uint32_t checksum_of(const log_relative_pca& prior);

/// The subject of a map and the layout of its file, from which all offsets follow.
struct svbrdf_header {
  Eigen::Index rows = 0, columns = 0;      ///< texels
  Eigen::Index band_rows = 0;              ///< rows of texels in a band; the last band may have fewer
  double eta = 0.0;                        ///< Tikhonov penalty
  std::uint32_t prior_checksum = 0;        ///< `checksum_of` the prior
  std::string prior_source;                ///< source of the prior's materials, for people
  std::vector<direction_pair> directions;  ///< pairs of directions in which the texels were measured
  Eigen::MatrixXf functions;  ///< k x r matrix that turns a texel's r weights into weights of the k components

  [[nodiscard]] Eigen::Index bands() const noexcept { return (rows + band_rows - 1) / band_rows; }
  [[nodiscard]] Eigen::Index texels_of_band(Eigen::Index band) const noexcept {
    return columns * std::min(band_rows, rows - band * band_rows);
  }
};

/// Returns a number that identifies a header: its CRC-32 in the file.
[[nodiscard]] std::uint32_t checksum_of(const svbrdf_header& header);

/// Returns the number of rows in a band of about 16,384 texels.
[[nodiscard]] Eigen::Index rows_of_band(Eigen::Index columns) noexcept;

/// A band's numbers as half floats, as in the file.
struct svbrdf_band {
  std::vector<std::uint16_t> weights;                    ///< per texel r weights of red, then of green, then of blue
  std::vector<std::uint16_t> uncertainty, disagreement;  ///< one number per texel

  /// Does the texel belong to the sample? Other texels are all zeros.
  [[nodiscard]] bool has_material(Eigen::Index texel) const { return uncertainty.at(texel) != 0; }
};

/// Rounds each number to 11 significant bits. A texel with nonzero uncertainty belongs to the sample: neither its
/// uncertainty nor all of its weights are rounded to zero. Throws gonio::error for a number too large for a half float.
[[nodiscard]] svbrdf_band as_halves(const texel_estimates& found, thread_count threads = {});

/// Returns a band's bytes in the file, its checksum last. Throws gonio::error unless its counts fit the header.
[[nodiscard]] std::vector<std::byte> write_band(const svbrdf_header& header, Eigen::Index band,
                                                const svbrdf_band& values);

/// Writes a map band by band into `PATH.part`, which is renamed to PATH when complete. If the process ends early, the
/// same job resumes after the last complete band and produces the same bytes. Only one process can have the file open.
class svbrdf_writer {
 public:
  /// Creates PATH.part or resumes it. Throws gonio::error, leaving it unchanged, if it belongs to another job (its
  /// header differs), is open in another process or cannot be written, or if `header` is invalid.
  svbrdf_writer(const std::filesystem::path& path, const svbrdf_header& header);

  /// Returns the number of bands already written, by this process or an earlier one.
  [[nodiscard]] Eigen::Index finished() const noexcept { return finished_; }

  /// Are these the bytes of a finished band? If not, a resumed job has other images than it started with.
  [[nodiscard]] bool has_written(Eigen::Index band, std::span<const std::byte> bytes) const;

  /// Appends the next band. Throws gonio::error if it cannot be stored, for example on a full disk: earlier bands stay.
  void append(const svbrdf_band& values);
  /// Appends the next band, given as the bytes that `write_band` returned, possibly in another process. Throws as the
  /// function above does, and if the bytes are damaged.
  void append(std::span<const std::byte> bytes);

  /// Renames the file to PATH once all bands are on the disk. Throws gonio::error if a band is missing.
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

/// A complete map, read band by band. Any number of threads may read it.
class svbrdf_map {
 public:
  /// Reads the header. Throws gonio::error if the file is not a map, is of another version, is damaged, or has another
  /// size than its header requires.
  explicit svbrdf_map(const std::filesystem::path& path);

  [[nodiscard]] const svbrdf_header& header() const noexcept { return header_; }

  /// Throws gonio::error if the band is damaged (checksum) or does not exist.
  [[nodiscard]] svbrdf_band read_band(Eigen::Index band) const;

  /// Throws gonio::error unless the map was made with this prior.
  void require_prior(const log_relative_pca& prior) const;

 private:
  std::filesystem::path path_;
  svbrdf_header header_;
  descriptor file_;
  std::uint64_t head_size_ = 0;
};

/// Does the file start with a map's magic word?
[[nodiscard]] bool is_svbrdf_map(const std::filesystem::path& path);

/// Returns the weights of the prior's k components for a texel of a band, k x 3, for `render::component_brdf` and
/// `fitted_brdf`; zeros outside the sample.
[[nodiscard]] Eigen::MatrixXd weights_of_texel(const svbrdf_header& header, const svbrdf_band& band,
                                               Eigen::Index texel);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/svbrdf_map.ipp>
#endif
