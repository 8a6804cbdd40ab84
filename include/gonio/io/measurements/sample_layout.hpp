#pragma once
/// Files of samples that state angles elsewhere than in columns: matrices, whose header line has the angles across
/// (`theta_o;0;30;60`), and angles that a line above the header line states for all of the file (`theta_i: 45`).

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// A polar angle down, which the first column holds, and the other one across.
struct sample_matrix {
  std::size_t down = 0, across = 0;  ///< theta_i and theta_o, or the other way round, as numbers of columns
  std::vector<double> angles = {};   ///< across, degrees, of each field behind the first
};

/// The column of a name, as the file's header line or its reader calls it.
using column_finder = std::function<std::size_t(std::string_view name)>;

/// The matrix that a header line begins: the first field names the angle down, or both, `theta_o \ theta_i`; the others
/// are angles of at most 90 degrees, 30 (perhaps with a degree sign) or theta_i=30. Nothing of any other line.
[[nodiscard]] std::optional<sample_matrix> matrix_of(std::span<const std::string_view> fields,
                                                     const column_finder& find_column);

/// For people: "theta_o down, theta_i across: 0, 30, 60 degrees".
[[nodiscard]] std::string description(const sample_matrix& matrix);

/// An angle for all samples of a file.
struct stated_angle {
  std::size_t column = 0;
  double degrees = 0.0;
};

/// What a line above the header line states of theta_i, phi_i, theta_o or phi_o: "Einfallswinkel: 45", "theta_i;45".
[[nodiscard]] std::optional<stated_angle> stated_angle_of(std::string_view line, const column_finder& find_column);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_layout.ipp>
#endif
