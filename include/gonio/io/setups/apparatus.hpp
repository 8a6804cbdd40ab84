#pragma once
/// Text files that describe an apparatus: where light and viewer can be and how well it measures, one line for each
/// rule, angles in degrees.
///
/// ```
/// # light and viewer: polar angles that they can have
/// light 0 75
/// viewer 45 45 1         # one angle, or a range, met to 1; one angle is met to 0.5 if nothing is said
/// separation 15          # of light and viewer at least
/// light_step 7.5 0.5     # lights at multiples of 7.5 degrees, met to 0.5
/// forbid 60 90 60 90     # light in the first range and viewer in the second
/// in_plane 0.5           # viewer in the plane of light and normal, met to 0.5
/// pair 45 0 20 180       # theta_i, phi_i, theta_o, phi_o: the apparatus measures only the pairs in such lines
/// noise 0.02             # deviation of a reading relative to it
/// dark_signal 0.0001     # deviation without light, as BRDF times both cosines, sr^-1
/// misplaced 0.5          # light and viewer may each be so far off their directions
/// ```

#include <gonio/design/apparatus.hpp>
#include <gonio/io/text/rules.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

namespace detail {

/// A range of polar angles from two numbers in degrees.
[[nodiscard]] design::polar_range read_polar_range(const text_rule& rule, std::size_t first, const text_place& place);

void apply_rule(const text_rule& rule, design::apparatus& described, const text_place& place);

}  // namespace detail

/// What no rule says is as of an apparatus without limits and errors. Throws gonio::error naming the line that is no
/// rule; `name` is what errors call the text.
[[nodiscard]] design::apparatus read_apparatus(std::string_view text, const std::string& name);

/// Reads a file of rules. Throws gonio::error naming the file and the line.
[[nodiscard]] design::apparatus read_apparatus(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/capture_constraint.ipp>
#endif
