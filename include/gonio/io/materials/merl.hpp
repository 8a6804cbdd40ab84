#pragma once
/// Dense tables in the binary format of the MERL database: three little-endian int32 (extents of theta_h,
/// theta_d, phi_d), then a plane of float64 for red, green and blue; a value times 1/1500, 1.15/1500 or
/// 1.66/1500 is in sr^-1. Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).
///
/// A file does not say at which point of a cell its values were taken. Cells without a value, -1 in all
/// three channels, are the only trace of it: see `infer_convention`.

#include <gonio/core/brdf.hpp>
#include <gonio/io/bytes/file.hpp>
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

namespace gonio::io {

static_assert(std::endian::native == std::endian::little,
              "MERL files are little-endian, as is every supported machine");

/// Where in its cells a table's values were taken, and how far above the horizon they begin.
struct table_convention {
  cell_anchor anchor = cell_anchor::centre;
  double minimum_cosine = 0.0;

  friend bool operator==(const table_convention&, const table_convention&) = default;
};

struct merl_options {
  /// Overrides what the cells marked -1 say.
  std::optional<table_convention> convention;
  /// Where a file turns out to be on these cells, its table shares them: reading a folder of tables then
  /// builds their index once.
  std::optional<valid_cells> shared;
};

namespace detail {

inline constexpr double merl_empty = -1.0;
inline constexpr std::size_t merl_header_size = 3 * sizeof(std::int32_t);

[[nodiscard]] std::string to_text(const grid_extents& extents);

/// Reads and checks the extents at the start of a file.
[[nodiscard]] grid_extents merl_extents(std::span<const std::byte> bytes, const std::string& name);

/// Size in bytes of a file with these extents, which `merl_extents` has checked.
[[nodiscard]] std::uint64_t merl_file_size(const grid_extents& extents);

/// The three planes of a file; its header leaves them misaligned.
class merl_planes {
 public:
  merl_planes(std::span<const std::byte> bytes, std::size_t cells) : data_(bytes.data()), cells_(cells) {}

  [[nodiscard]] double operator()(std::size_t channel, std::size_t linear) const noexcept;
  [[nodiscard]] bool empty(std::size_t linear) const noexcept {
    return (*this)(0, linear) == merl_empty && (*this)(1, linear) == merl_empty && (*this)(2, linear) == merl_empty;
  }

 private:
  const std::byte* data_;
  std::size_t cells_;
};

/// How an anchor sorts the cells by the smaller of their two cosines.
struct mark_statistics {
  double largest_marked = -std::numeric_limits<double>::infinity();
  double smallest_unmarked = std::numeric_limits<double>::infinity();

  /// How well the anchor explains the marks: 0 not at all; 1 by a threshold, but cells below the horizon
  /// are filled; 2 by a threshold above the horizon; 3 by the horizon itself.
  [[nodiscard]] int rank() const noexcept;

  /// The threshold that belongs to it, never below the horizon.
  [[nodiscard]] double minimum_cosine() const noexcept {
    return rank() == 2 ? 0.5 * (largest_marked + smallest_unmarked) : 0.0;
  }
};

template <std::predicate<std::size_t> Marked>
[[nodiscard]] mark_statistics sort_marks(const grid& cells, const Marked& marked) {
  mark_statistics found;
  for_each_smaller_cosine(cells, [&](std::size_t linear, double cosine) {
    if (std::abs(cosine) <= valid_cells::horizon) return;
    if (marked(linear))
      found.largest_marked = std::max(found.largest_marked, cosine);
    else
      found.smallest_unmarked = std::min(found.smallest_unmarked, cosine);
  });
  return found;
}

}  // namespace detail

/// Finds the convention of a table from which of its cells are marked as empty.
///
/// An anchor explains the marks if at its nodes the smaller cosine of every marked cell lies below that of
/// every unmarked one. Its minimum cosine is 0 unless marked cells lie above the horizon, then the middle
/// of the gap. Where both anchors explain them, one with the horizon in its gap goes before one with a gap
/// above it, and that before one with filled cells below the horizon; among equals the centre. Where
/// neither does, as for the files of the MERL database itself, and where nothing is marked, the answer is
/// centre and 0. Cells within 1e-9 of the horizon have no say.
template <std::predicate<std::size_t> Marked>
[[nodiscard]] table_convention infer_convention(const grid_extents& extents, const Marked& marked) {
  const detail::mark_statistics centre = detail::sort_marks(grid(extents, cell_anchor::centre), marked);
  const detail::mark_statistics corner = detail::sort_marks(grid(extents, cell_anchor::lower_corner), marked);
  if (corner.rank() > centre.rank()) return {cell_anchor::lower_corner, corner.minimum_cosine()};
  return {cell_anchor::centre, centre.minimum_cosine()};
}

namespace detail {

[[noreturn]] void refuse_cell(const std::string& name, const grid& cells, std::size_t linear, std::size_t channel,
                              double value);

}  // namespace detail

/// A table from the bytes of a MERL file; `name` is what errors call it. Values at cells below the horizon
/// are ignored. Negative values at the others are measurements and stay; NaN and infinity are refused.
[[nodiscard]] brdf_table read_merl(std::span<const std::byte> bytes, const std::string& name,
                                   const merl_options& options = {});

/// Reads an uncompressed MERL file.
[[nodiscard]] inline brdf_table read_merl(const std::filesystem::path& path, const merl_options& options = {}) {
  return read_merl(read_bytes(path), path.string(), options);
}

/// Writes a table; what is read back is equal to it. The format has no place for the table's anchor and
/// minimum cosine: they are carried by the cells marked -1 alone, so that a grid so coarse that two
/// conventions mark the same cells comes back as the first of them (see `infer_convention`).
void write_merl(const std::filesystem::path& path, const brdf_table& table);

/// Tabulates a BRDF and writes the table; a fit that tabulates itself does so.
template <brdf Brdf>
requires(!std::same_as<Brdf, brdf_table>) void write_merl(const std::filesystem::path& path, const Brdf& f,
                                                          const valid_cells& cells = valid_cells()) {
  if constexpr (requires {
                  { f.tabulate(cells) } -> std::same_as<brdf_table>;
                })
    write_merl(path, f.tabulate(cells));
  else
    write_merl(path, tabulate(f, cells));
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/merl.ipp>
#endif
