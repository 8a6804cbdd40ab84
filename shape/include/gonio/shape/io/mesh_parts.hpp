#pragma once
/// Shared parts of the mesh readers.

#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Takes the next word off the front of a line; empty at the end of the line.
[[nodiscard]] std::string_view read_word(std::string_view& line) noexcept;

/// The data read from a file so far.
struct mesh_parts {
  std::vector<double> coordinates;  // x, y and z of each vertex in turn
  std::vector<int> corners;         // the three vertices of each triangle in turn

  [[nodiscard]] std::size_t vertices() const noexcept { return coordinates.size() / 3; }
};

/// Splits a polygon into a fan about its first vertex. Ignores positions, so corresponded shapes are split alike.
class polygon_fan {
 public:
  explicit polygon_fan(std::vector<int>& corners) noexcept : corners_(corners) {}

  void add(int vertex);
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  std::vector<int>& corners_;
  std::size_t size_ = 0;
  int first_ = 0, last_ = 0;
};

inline constexpr int mesh_vertex_limit = std::numeric_limits<int>::max();

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/mesh_parts.ipp>
#endif
