#pragma once
/// Dense tables in the binary format of the MERL database: three little-endian int32 (extents of theta_h,
/// theta_d, phi_d), then a plane of float64 for red, green and blue; a value times 1/1500, 1.15/1500 or
/// 1.66/1500 is in sr^-1. Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003.
///
/// A file does not say at which point of a cell its values were taken. Cells without a value, -1 in all
/// three channels, are the only trace of it: see `infer_convention`.

#include <gonio/core/brdf.hpp>
#include <gonio/io/file.hpp>
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

[[nodiscard]] inline std::string to_text(const grid_extents& extents) {
  return std::to_string(extents.theta_h) + " x " + std::to_string(extents.theta_d) + " x " +
         std::to_string(extents.phi_d);
}

/// Reads and checks the extents at the start of a file.
[[nodiscard]] inline grid_extents merl_extents(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() < merl_header_size)
    throw error(name + ": has " + std::to_string(bytes.size()) + " bytes, expected at least " +
                std::to_string(merl_header_size) + " for the extents of a MERL table");
  std::array<std::int32_t, 3> header{};
  std::memcpy(header.data(), bytes.data(), merl_header_size);
  const grid_extents extents{header[0], header[1], header[2]};
  for (const std::int32_t extent : header)
    if (extent < 1 || extent > 4096)
      throw error(name + ": is no MERL table, its extents are " + to_text(extents) + ", expected each from 1 to 4096");
  return extents;
}

/// Size in bytes of a file with these extents, which `merl_extents` has checked.
[[nodiscard]] inline std::uint64_t merl_file_size(const grid_extents& extents) {
  const auto wide = [](int extent) { return static_cast<std::uint64_t>(extent); };
  return merl_header_size + 3 * sizeof(double) * wide(extents.theta_h) * wide(extents.theta_d) * wide(extents.phi_d);
}

/// The three planes of a file; its header leaves them misaligned.
class merl_planes {
 public:
  merl_planes(std::span<const std::byte> bytes, std::size_t cells) : data_(bytes.data()), cells_(cells) {}

  [[nodiscard]] double operator()(std::size_t channel, std::size_t linear) const noexcept {
    double value = 0.0;
    std::memcpy(&value, data_ + sizeof value * (channel * cells_ + linear), sizeof value);
    return value;
  }
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
  [[nodiscard]] int rank() const noexcept {
    if (!std::isfinite(smallest_unmarked) || !(largest_marked + valid_cells::horizon < smallest_unmarked)) return 0;
    if (smallest_unmarked <= 0.0) return 1;
    return largest_marked > 0.0 ? 2 : 3;
  }

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

[[noreturn]] inline void refuse_cell(const std::string& name, const grid& cells, std::size_t linear,
                                     std::size_t channel, double value) {
  constexpr std::array<const char*, 3> channels{"red", "green", "blue"};
  const cell_index cell = cells.cell(linear);
  throw error(name + ": " + channels[channel] + " of cell (theta_h " + std::to_string(cell.theta_h) + ", theta_d " +
              std::to_string(cell.theta_d) + ", phi_d " + std::to_string(cell.phi_d) + ") is " + std::to_string(value) +
              ", expected a finite number");
}

}  // namespace detail

/// A table from the bytes of a MERL file; `name` is what errors call it. Values at cells below the horizon
/// are ignored. Negative values at the others are measurements and stay; NaN and infinity are refused.
[[nodiscard]] inline brdf_table parse_merl(std::span<const std::byte> bytes, const std::string& name,
                                           const merl_options& options = {}) {
  const grid_extents extents = detail::merl_extents(bytes, name);
  if (const std::uint64_t expected = detail::merl_file_size(extents); bytes.size() != expected)
    throw error(name + ": has " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(expected) +
                " for a MERL table of " + detail::to_text(extents) + " cells");
  const detail::merl_planes planes(bytes.subspan(detail::merl_header_size), grid(extents).size());
  const table_convention convention =
      options.convention ? *options.convention
                         : infer_convention(extents, [&](std::size_t linear) { return planes.empty(linear); });

  const grid cells(extents, convention.anchor);
  const bool share = options.shared && options.shared->grid() == cells &&
                     options.shared->minimum_cosine() == convention.minimum_cosine;
  brdf_table table(share ? *options.shared : valid_cells(cells, convention.minimum_cosine));
  const std::span<float> values = table.values();
  for (std::size_t cell = 0; cell < table.cells().size(); ++cell) {
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

/// Reads an uncompressed MERL file.
[[nodiscard]] inline brdf_table read_merl(const std::filesystem::path& path, const merl_options& options = {}) {
  return parse_merl(read_bytes(path), path.string(), options);
}

/// Writes a table; what is read back is equal to it. The format has no place for the table's anchor and
/// minimum cosine: they are carried by the cells marked -1 alone, so that a grid so coarse that two
/// conventions mark the same cells comes back as the first of them (see `infer_convention`).
inline void write_merl(const std::filesystem::path& path, const brdf_table& table) {
  const grid& cells = table.cells().grid();
  const auto [theta_h, theta_d, phi_d] = cells.extents();
  const std::array<std::int32_t, 3> header{theta_h, theta_d, phi_d};
  std::vector<double> plane(cells.size(), detail::merl_empty);
  write_atomically(path, [&](file_writer& file) {
    file.write(std::as_bytes(std::span(header)));
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (std::size_t cell = 0; cell < table.cells().size(); ++cell) {
        const double value = double{table.values()[3 * cell + channel]};
        const std::size_t linear = table.cells().linear(cell);
        if (!std::isfinite(value)) detail::refuse_cell(path.string(), cells, linear, channel, value);
        plane[linear] = value / merl_scale[channel];
      }
      file.write(std::as_bytes(std::span(plane)));
    }
  });
}

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
