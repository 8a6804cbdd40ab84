#pragma once
/// The columns of a file of samples and their possible names: English, French and German, Greek letters, units after a
/// name or on a line of their own.

#include <gonio/io/measurements/sample_quantity.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace gonio::io::detail {

// The columns, grouped; the numbers below index this list. `quantity` holds text.
inline constexpr std::array<std::string_view, 28> sample_columns{"theta_h",
                                                                 "theta_d",
                                                                 "phi_d",
                                                                 "theta_i",
                                                                 "phi_i",
                                                                 "theta_o",
                                                                 "phi_o",
                                                                 "wi_x",
                                                                 "wi_y",
                                                                 "wi_z",
                                                                 "wo_x",
                                                                 "wo_y",
                                                                 "wo_z",
                                                                 "r",
                                                                 "g",
                                                                 "b",
                                                                 "weight",
                                                                 "weight_r",
                                                                 "weight_g",
                                                                 "weight_b",
                                                                 "value",
                                                                 "wavelength",
                                                                 "source_half_angle",
                                                                 "receiver_half_angle",
                                                                 "quantity",
                                                                 "X",
                                                                 "Y",
                                                                 "Z"};

struct column_group {
  std::size_t first = 0;
  std::size_t count = 0;

  [[nodiscard]] bool has(std::size_t column) const noexcept { return column >= first && column < first + count; }
};
inline constexpr column_group half_difference_group{0, 3};
inline constexpr column_group angle_group{3, 4};
inline constexpr column_group vector_group{7, 6};
inline constexpr column_group colour_group{13, 3};
inline constexpr column_group weight_group{16, 1};
inline constexpr column_group channel_weight_group{17, 3};
inline constexpr column_group grey_group{20, 1};
inline constexpr std::size_t wavelength_column = 21, quantity_column = 24;
inline constexpr column_group half_angle_group{22, 2};
inline constexpr column_group tristimulus_group{25, 3};

/// Does the column hold an angle in degrees?
[[nodiscard]] constexpr bool is_angle(std::size_t column) noexcept {
  return column < vector_group.first || half_angle_group.has(column);
}

/// A field of the header line as written, and its name and unit in lower case: "Theta In [deg]", "theta in" and "deg".
struct written_column {
  std::string text, name, unit;
};

/// Splits a field of the header line. The unit is in brackets after the name, or is the last word: theta_i_deg.
[[nodiscard]] written_column written(std::string_view field);

enum class column_unit { none, degrees, radians, nanometres, percent, per_steradian, unknown };
[[nodiscard]] column_unit unit_named(std::string_view name);

/// A possible name of a column, in lower-case letters and digits only: Theta_In, "theta in" and thetaIn are one name.
struct known_name {
  std::string_view letters;
  std::size_t column;
  std::optional<sample_quantity> quantity = {};  ///< if the name implies it
  bool is_relative = false;                      ///< true for a name of phi_o - phi_i
};

/// Returns the entry of a name in English, French, German (accents in UTF-8 or Latin-1) or Greek letters, or nullptr.
[[nodiscard]] const known_name* find_known(std::string_view name);

/// Can a column have this unit?
[[nodiscard]] bool fits(column_unit unit, std::size_t column);

/// Are these the fields of a line of units, as some programs write below the header line: no number, at least one unit?
[[nodiscard]] bool are_units(std::span<const std::string_view> fields);

/// Returns a field without a degree sign or the word "deg" at its end.
[[nodiscard]] std::string_view without_degree_sign(std::string_view field);

/// Returns the unit in a field of a line of units, in lower case and without brackets.
[[nodiscard]] std::string unit_of(std::string_view field);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_columns.ipp>
#endif
