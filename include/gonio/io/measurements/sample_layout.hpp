#pragma once
/// Files of samples that state angles outside of columns: matrices, whose header line lists angles (`theta_o;0;30;60`),
/// and a line above the header line that states an angle for the whole file (`theta_i: 45`).

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// A matrix of values. The first column lists one polar angle (down); the header line lists the other (across).
struct sample_matrix {
  std::size_t down = 0, across = 0;  ///< columns of theta_i and theta_o, or the other way round
  std::vector<double> angles = {};   ///< of the header line, degrees, for each field after the first
};

/// Returns the column of a name that the file or its caller uses.
using column_finder = std::function<std::size_t(std::string_view name)>;

/// Returns the matrix of a header line; nothing for any other line. The first field names the angle of the first
/// column, or both angles, as in `theta_o \ theta_i`. The other fields are angles of at most 90 degrees, such as 30
/// (with or without a degree sign) or theta_i=30.
[[nodiscard]] std::optional<sample_matrix> matrix_of(std::span<const std::string_view> fields,
                                                     const column_finder& find_column);

/// Returns a description for people: "theta_o down, theta_i across: 0, 30, 60 degrees".
[[nodiscard]] std::string description(const sample_matrix& matrix);

/// An angle that applies to all samples of a file.
struct stated_angle {
  std::size_t column = 0;
  double degrees = 0.0;
};

/// Returns the angle (theta_i, phi_i, theta_o or phi_o) that a line above the header line states, such as
/// "Einfallswinkel: 45" or "theta_i;45".
[[nodiscard]] std::optional<stated_angle> stated_angle_of(std::string_view line, const column_finder& find_column);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_layout.ipp>
#endif
