#pragma once
/// Bodies of io/setups/apparatus.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/design/apparatus.hpp>
#include <gonio/io/setups/apparatus.hpp>
#include <gonio/io/text/rules.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io::detail {

GONIO_INLINE design::polar_range read_polar_range(const text_rule& rule, std::size_t first,
                                                  const text_position& position) {
  const double smallest = rule.numbers[first], largest = rule.numbers[first + 1];
  if (!(smallest >= 0.0 && smallest <= largest && largest <= 90.0))
    position.refuse("a range of polar angles needs two numbers from 0 to 90, the smaller one first");
  return {radians(smallest), radians(largest)};
}

/// The tolerance of an angle or of the plane if its rule gives none.
inline constexpr double default_tolerance = radians(0.5);

[[nodiscard]] GONIO_INLINE double read_tolerance(double angle, const text_position& position) {
  if (!(angle >= 0.0 && angle <= 90.0)) position.refuse("the tolerance of an angle must be from 0 to 90 degrees");
  return radians(angle);
}

[[nodiscard]] GONIO_INLINE direction_pair read_pair(const text_rule& rule, const text_position& position) {
  require_numbers(rule, {4}, position);
  const std::vector<double>& angles = rule.numbers;
  if (!(angles[0] >= 0.0 && angles[0] < 90.0 && angles[2] >= 0.0 && angles[2] < 90.0))
    position.refuse("the polar angles of a pair must be at least 0 and less than 90 degrees");
  return {spherical_direction(radians(angles[0]), radians(angles[1])),
          spherical_direction(radians(angles[2]), radians(angles[3]))};
}

/// Returns a rule's only number, from 0 to less than a limit.
[[nodiscard]] GONIO_INLINE double only_number_of(const text_rule& rule, double limit, const text_position& position) {
  require_numbers(rule, {1}, position);
  if (!(rule.numbers[0] >= 0.0 && rule.numbers[0] < limit))
    position.refuse(in_quotes(rule.name) + " must be at least 0 and less than " + shortest(limit));
  return rule.numbers[0];
}

GONIO_INLINE void apply_rule(const text_rule& rule, design::apparatus& described, const text_position& position) {
  design::capture_constraint& constraint = described.constraint;
  if (rule.name == "light" || rule.name == "viewer") {
    require_numbers(rule, {2, 3}, position);
    design::polar_range range = read_polar_range(rule, 0, position);
    const bool is_single = range.smallest == range.largest;
    const double tolerance =
        rule.numbers.size() == 3 ? read_tolerance(rule.numbers[2], position) : (is_single ? default_tolerance : 0.0);
    range.smallest -= tolerance;
    range.largest += tolerance;
    (rule.name == "light" ? constraint.light : constraint.viewer) = range;
  } else if (rule.name == "separation") {
    require_numbers(rule, {1}, position);
    if (!(rule.numbers[0] >= 0.0 && rule.numbers[0] <= 180.0))
      position.refuse("a separation must be from 0 to 180 degrees");
    constraint.smallest_separation = radians(rule.numbers[0]);
  } else if (rule.name == "light_step") {
    require_numbers(rule, {1, 2}, position);
    if (!(rule.numbers[0] > 0.0)) position.refuse("a step between lights must be positive");
    constraint.light_step = radians(rule.numbers[0]);
    if (rule.numbers.size() == 2) constraint.light_tolerance = read_tolerance(rule.numbers[1], position);
  } else if (rule.name == "forbid") {
    require_numbers(rule, {4}, position);
    constraint.forbidden.push_back({read_polar_range(rule, 0, position), read_polar_range(rule, 2, position)});
  } else if (rule.name == "in_plane") {
    require_numbers(rule, {0, 1}, position);
    constraint.plane_tolerance = rule.numbers.empty() ? default_tolerance : read_tolerance(rule.numbers[0], position);
  } else if (rule.name == "pair") {
    constraint.pairs.push_back(read_pair(rule, position));
  } else if (rule.name == "noise") {
    described.noise = only_number_of(rule, 1.0, position);
  } else if (rule.name == "dark_signal") {
    described.dark_signal = only_number_of(rule, 1.0, position);
  } else if (rule.name == "misplaced") {
    described.angular_error = radians(only_number_of(rule, 45.0, position));
  } else {
    position.refuse(in_quotes(rule.name) +
                    " is not a rule, expected light, viewer, separation, light_step, forbid, in_plane, pair, noise, "
                    "dark_signal or misplaced");
  }
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE design::apparatus read_apparatus(std::string_view text, const std::string& name) {
  design::apparatus described;
  text_position position{name};
  for_each_line(text, position, [&](std::string_view line) {
    detail::apply_rule(detail::read_rule(line, position), described, position);
  });
  return described;
}

GONIO_INLINE design::apparatus read_apparatus(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return read_apparatus(as_text(bytes), path.string());
}

}  // namespace gonio::io
