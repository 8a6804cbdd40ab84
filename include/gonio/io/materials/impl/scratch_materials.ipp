#pragma once
/// Bodies of io/materials/scratch_materials.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/scratch_materials.hpp>

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio::io {

namespace detail {

/// Opens an unnamed file, or a named one and removes its name at once.
[[nodiscard]] GONIO_INLINE descriptor open_scratch(const std::filesystem::path& folder) {
  const auto fail = [&] { refuse_file(folder, {"cannot hold a scratch file: ", system_reason(errno)}); };
#if defined(O_TMPFILE)
  descriptor unnamed(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (unnamed.is_open()) return unnamed;
#endif
  const std::filesystem::path path = folder / temporary_name(next_temporary++).c_str();
  descriptor named(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!named.is_open() || ::unlink(path.c_str()) != 0) fail();
  return named;
}

}  // namespace detail

/// The file is a sequence of row-major matrices. Each has a row per cell, and the columns of the materials that were
/// written together.
struct scratch_materials::state {
  struct part {
    std::uint64_t offset;       ///< in the file
    Eigen::Index first, count;  ///< columns
  };

  std::filesystem::path folder;
  std::uint64_t memory;
  std::vector<std::string> names;
  std::optional<valid_cells> cells;  ///< of the first material
  std::vector<double> wavelengths;   ///< of the first material
  std::vector<cell_matrix> held;     ///< the last tables, not yet in the file
  std::vector<part> parts;
  descriptor file;
  std::uint64_t size = 0;

  /// Returns the number of columns of the tables in memory.
  [[nodiscard]] Eigen::Index held_columns() const { return held.empty() ? 0 : std::ssize(held) * held.front().cols(); }

  /// Copies rows of the tables in memory to columns of `out`.
  void gather(block range, cell_rows out) const {
    for (Eigen::Index m = 0; m < std::ssize(held); ++m) {
      const Eigen::Index channels = held[m].cols();
      const float* value = held[m].data() + channels * range.begin;
      for (Eigen::Index row = 0; row < range.size(); ++row, value += channels)
        std::copy_n(value, channels, &out(row, channels * m));
    }
  }

  void append(const std::string& name, const valid_cells& over, std::vector<double> at, cell_matrix table) {
    if (table.rows() != over.size() || table.cols() != channels_at<valid_cells>(at))
      refuse({"material '", name, "' has ", table.rows(), " x ", table.cols(), " values, expected ", over.size(), " x ",
              channels_at<valid_cells>(at)});
    if (cells && !(*cells == over)) refuse({"material '", name, "' has other cells than the first material"});
    if (cells && at != wavelengths) refuse({"material '", name, "' has other wavelengths than the first material"});
    const std::uint64_t bytes = sizeof(float) * static_cast<std::uint64_t>(table.size());
    if (!held.empty() && bytes * (held.size() + 1) > memory) write_held();
    cells = over;
    wavelengths = std::move(at);
    names.push_back(name);
    held.push_back(std::move(table));
  }

  void write_held() {
    if (!file.is_open()) file = detail::open_scratch(folder);
    const Eigen::Index rows_of_all = cells->size(), columns = held_columns();
    parts.push_back({size, std::ssize(names) * held.front().cols() - columns, columns});
    const Eigen::Index at_once = std::max<Eigen::Index>(1, (Eigen::Index{1} << 18) / columns);
    cell_matrix rows(at_once, columns);
    for (Eigen::Index begin = 0; begin < rows_of_all; begin += at_once) {
      const block range{begin, std::min(rows_of_all, begin + at_once)};
      gather(range, rows.topRows(range.size()));
      const auto bytes = std::as_bytes(std::span(rows.data(), static_cast<std::size_t>(range.size() * columns)));
      if (!write_all(file, bytes))
        refuse_file(folder, {"cannot hold a scratch file of the tables: ", system_reason(errno)});
      size += bytes.size();
    }
    held.clear();
  }

  void read(block range, cell_rows out) const {
    std::vector<float> rows;
    for (const part& each : parts) {
      rows.resize(static_cast<std::size_t>(range.size() * each.count));
      const auto bytes = std::as_writable_bytes(std::span(rows));
      const std::uint64_t offset = each.offset + sizeof(float) * static_cast<std::uint64_t>(range.begin) *
                                                     static_cast<std::uint64_t>(each.count);
      if (read_at(file, offset, bytes, folder) != bytes.size())
        refuse_file(folder, "the scratch file of the tables became shorter");
      for (Eigen::Index row = 0; row < range.size(); ++row)
        std::copy_n(rows.data() + row * each.count, each.count, &out(row, each.first));
    }
    if (!held.empty()) gather(range, out.rightCols(held_columns()));
  }
};

GONIO_INLINE scratch_materials::scratch_materials(std::filesystem::path folder, std::uint64_t memory)
    : state_(std::make_shared<state>()) {
  state_->folder = folder.empty() ? std::filesystem::path(".") : std::move(folder);
  state_->memory = memory;
}

GONIO_INLINE void scratch_materials::append(const std::string& name, const brdf_table& table) {
  const Eigen::Index cells = table.cells().size();
  state_->append(name, table.cells(), {}, Eigen::Map<const cell_matrix>(table.values().data(), cells, 3));
}

GONIO_INLINE void scratch_materials::append(const std::string& name, spectral_table table) {
  state_->append(name, table.cells(), table.wavelengths(), std::move(table.values()));
}

GONIO_INLINE void scratch_materials::append(const std::string& name, const valid_cells& cells,
                                            std::vector<double> wavelengths, cell_matrix values) {
  state_->append(name, cells, std::move(wavelengths), std::move(values));
}

GONIO_INLINE material_rows scratch_materials::rows() {
  if (state_->names.empty()) refuse("at least one material is needed");
  if (state_->file.is_open() && !state_->held.empty()) state_->write_held();
  return {*state_->cells, state_->names, [held = state_](block range, cell_rows out) { held->read(range, out); },
          state_->wavelengths};
}

GONIO_INLINE std::uint64_t scratch_materials::file_size() const noexcept { return state_->size; }

}  // namespace gonio::io
