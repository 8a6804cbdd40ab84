#pragma once
/// Text files that say what an apparatus cannot do: one line for each rule, angles in degrees.
///
/// ```
/// # light and viewer: polar angles that they can have
/// light 0 75
/// viewer 45 45 1         # one angle, or a range, met to 1; one angle is met to 0.5 if nothing is said
/// separation 15          # of light and viewer at least
/// light_step 7.5 0.5     # lights at multiples of 7.5 degrees, met to 0.5
/// forbid 60 90 60 90     # light in the first range and viewer in the second
/// in_plane 0.5           # viewer in the plane of light and normal, met to 0.5
/// ```

#include <gonio/design/capture_constraint.hpp>
#include <gonio/io/text/rules.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

namespace detail {

/// A range of polar angles from two numbers in degrees.
[[nodiscard]] design::polar_range read_polar_range(const text_rule& rule, std::size_t first, const text_place& place);

void apply_rule(const text_rule& rule, design::capture_constraint& constraint, const text_place& place);

}  // namespace detail

/// Throws gonio::error naming the line that is no rule; `name` is what errors call the text.
[[nodiscard]] design::capture_constraint read_capture_constraint(std::string_view text, const std::string& name);

/// Reads a file of rules. Throws gonio::error naming the file and the line.
[[nodiscard]] design::capture_constraint read_capture_constraint(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/capture_constraint.ipp>
#endif
