#pragma once
/// Text files that describe an apparatus: the possible directions of light and viewer, and the errors of its readings.
/// One line for each rule, angles in degrees.
///
/// ```
/// # polar angles of light and viewer
/// light 0 75
/// viewer 45 45 1         # an angle or a range, with a tolerance of 1; without it, 0.5 for an angle and 0 for a range
/// separation 15          # smallest angle between light and viewer
/// light_step 7.5 0.5     # lights at multiples of 7.5 degrees, with a tolerance of 0.5
/// forbid 60 90 60 90     # light in the first range while viewer is in the second
/// in_plane 0.5           # viewer in the plane of light and normal, with a tolerance of 0.5
/// pair 45 0 20 180       # theta_i, phi_i, theta_o, phi_o: the apparatus measures only the listed pairs
/// noise 0.02             # relative standard deviation of a reading
/// dark_signal 0.0001     # standard deviation without light, as BRDF times both cosines, sr^-1
/// misplaced 0.5          # angular error of light and of viewer
/// ```

#include <gonio/design/apparatus.hpp>
#include <gonio/io/text/rules.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

namespace detail {

/// Reads a range of polar angles from the rule's numbers `first` and `first` + 1, in degrees.
[[nodiscard]] design::polar_range read_polar_range(const text_rule& rule, std::size_t first,
                                                   const text_position& position);

void apply_rule(const text_rule& rule, design::apparatus& described, const text_position& position);

}  // namespace detail

/// Reads an apparatus. Without rules it has no limits and no errors. Throws gonio::error naming a line that is not a
/// rule. Errors call the text `name`.
[[nodiscard]] design::apparatus read_apparatus(std::string_view text, const std::string& name);

/// Reads a file of rules.
[[nodiscard]] design::apparatus read_apparatus(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/apparatus.ipp>
#endif
