#pragma once
/// Dense tables in the binary format of the MERL database: three little-endian int32 (extents of theta_h, theta_d,
/// phi_d), then a plane of float64 for red, green and blue; a value times 1/1500, 1.15/1500 or 1.66/1500 is in sr^-1.
/// Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).
///
/// A file does not state at which point of a cell its value was taken. `infer_convention` infers the point from the
/// cells without a value, which are -1 in all three channels.

#include <gonio/core/brdf.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/table_convention.hpp>

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

static_assert(std::endian::native == std::endian::little,
              "MERL files are little-endian, as is every supported machine");

struct merl_options {
  /// Overrides the convention inferred from the cells marked -1.
  std::optional<table_convention> convention;
  /// Cells of another table. A file with the same cells shares them, which saves building their index again.
  std::optional<valid_cells> shared;
};

namespace detail {

inline constexpr std::size_t merl_header_size = 3 * sizeof(std::int32_t);

[[nodiscard]] std::string to_text(const grid_extents& extents);

/// Reads and checks the extents at the start of a file.
[[nodiscard]] grid_extents merl_extents(std::span<const std::byte> bytes, const std::string& name);

/// Returns the size in bytes of a file with these extents, which `merl_extents` has checked.
[[nodiscard]] std::uint64_t merl_file_size(const grid_extents& extents);

/// The three planes of a file, which the header's 12 bytes misalign.
class merl_planes {
 public:
  merl_planes(std::span<const std::byte> bytes, std::size_t cells) : data_(bytes.data()), cells_(cells) {}

  [[nodiscard]] double operator()(std::size_t channel, std::size_t linear) const noexcept;
  [[nodiscard]] bool empty(std::size_t linear) const noexcept {
    constexpr double empty = gonio::detail::merl_empty;
    return (*this)(0, linear) == empty && (*this)(1, linear) == empty && (*this)(2, linear) == empty;
  }

 private:
  const std::byte* data_;
  std::size_t cells_;
};

[[noreturn]] void refuse_cell(const std::string& name, const grid& cells, std::size_t linear, std::size_t channel,
                              double value);

}  // namespace detail

/// Reads a table from the bytes of a MERL file. Ignores values of cells below the horizon. Negative values of other
/// cells are measurements and are kept. Refuses NaN and infinity. Errors call the file `name`.
[[nodiscard]] brdf_table read_merl(std::span<const std::byte> bytes, const std::string& name,
                                   const merl_options& options = {});

/// Reads an uncompressed MERL file.
[[nodiscard]] inline brdf_table read_merl(const std::filesystem::path& path, const merl_options& options = {}) {
  return read_merl(read_bytes(path), path.string(), options);
}

/// Writes a table; reading it back gives an equal table. The format has no field for the table's anchor and minimum
/// cosine: only the cells marked -1 carry them. If a grid is so coarse that two conventions mark the same cells, the
/// file is read with the convention that `infer_convention` prefers.
void write_merl(const std::filesystem::path& path, const brdf_table& table);

/// Tabulates a BRDF, by its own `tabulate` if it has one, and writes the table.
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
