#pragma once
/// Bodies of io/scratch_materials.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/scratch_materials.hpp>

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>
#include <vector>

namespace gonio::io {

namespace detail {

/// A file without a name, or one whose name is removed at once.
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

/// The file is one matrix behind the other, row-major: cells x columns of as many materials as came together.
struct scratch_materials::state {
  struct part {
    std::uint64_t offset;       ///< in the file
    Eigen::Index first, count;  ///< columns
  };

  std::filesystem::path folder;
  std::uint64_t memory;
  std::vector<std::string> names;
  std::vector<brdf_table> held;  ///< the last ones, not in the file
  std::vector<part> parts;
  detail::descriptor file;
  std::uint64_t size = 0;

  /// Copies rows of the tables that are in memory to some columns.
  void gather(block range, cell_rows out) const {
    for (Eigen::Index m = 0; m < std::ssize(held); ++m) {
      const float* value = held[m].values().data() + 3 * range.begin;
      for (Eigen::Index row = 0; row < range.size(); ++row, value += 3) std::copy_n(value, 3, &out(row, 3 * m));
    }
  }

  void write_held() {
    if (!file.is_open()) file = detail::open_scratch(folder);
    const Eigen::Index cells = held.front().cells().size(), columns = 3 * std::ssize(held);
    parts.push_back({size, 3 * std::ssize(names) - columns, columns});
    const Eigen::Index at_once = std::max<Eigen::Index>(1, (Eigen::Index{1} << 18) / columns);
    cell_matrix rows(at_once, columns);
    for (Eigen::Index begin = 0; begin < cells; begin += at_once) {
      const block range{begin, std::min(cells, begin + at_once)};
      gather(range, rows.topRows(range.size()));
      const auto bytes = std::as_bytes(std::span(rows.data(), static_cast<std::size_t>(range.size() * columns)));
      if (!detail::write_all(file, bytes))
        detail::refuse_file(folder, {"cannot hold a scratch file of the tables: ", detail::system_reason(errno)});
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
      if (detail::read_at(file, offset, bytes, folder) != bytes.size())
        detail::refuse_file(folder, "the scratch file of the tables became shorter");
      for (Eigen::Index row = 0; row < range.size(); ++row)
        std::copy_n(rows.data() + row * each.count, each.count, &out(row, each.first));
    }
    if (!held.empty()) gather(range, out.rightCols(3 * std::ssize(held)));
  }
};

GONIO_INLINE scratch_materials::scratch_materials(std::filesystem::path folder, std::uint64_t memory)
    : state_(std::make_shared<state>()) {
  state_->folder = folder.empty() ? std::filesystem::path(".") : std::move(folder);
  state_->memory = memory;
}

GONIO_INLINE void scratch_materials::append(const std::string& name, brdf_table table) {
  state& all = *state_;
  const std::uint64_t bytes = sizeof(float) * table.values().size();
  if (!all.held.empty() && !(all.held.front().cells() == table.cells()))
    refuse({"material '", name, "' is over other cells than the first one"});
  if (!all.held.empty() && bytes * (all.held.size() + 1) > all.memory) all.write_held();
  all.names.push_back(name);
  all.held.push_back(std::move(table));
}

GONIO_INLINE material_rows scratch_materials::rows() {
  if (state_->names.empty()) refuse("there is no material");
  const valid_cells cells = state_->held.front().cells();
  if (state_->file.is_open()) state_->write_held();
  return {cells, state_->names, [held = state_](block range, cell_rows out) { held->read(range, out); }};
}

GONIO_INLINE std::uint64_t scratch_materials::file_size() const noexcept { return state_->size; }

}  // namespace gonio::io
