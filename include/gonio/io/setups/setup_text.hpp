#pragma once
/// Common parts of the text files that describe how something was photographed (io/setups/near_field_setup.hpp,
/// io/setups/sphere_setup.hpp): a line for each entry, and the entries for camera, lens, light and white image.

#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/io/text/rules.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// An entry's name and how many numbers it takes: `numbers`. If `or_numbers` is not 0, it may take `or_numbers`
/// instead.
struct setup_entry {
  std::string_view name;
  std::size_t numbers = 0, or_numbers = 0;
};

/// The entries that every set-up may have.
inline constexpr std::array<setup_entry, 19> photograph_entries{{{"size", 2},
                                                                 {"focal_length", 1, 2},
                                                                 {"field_of_view", 1},
                                                                 {"principal_point", 2},
                                                                 {"distortion", 4, 5},
                                                                 {"position", 3},
                                                                 {"target", 3},
                                                                 {"up", 3},
                                                                 {"rotation", 9},
                                                                 {"light", 3},
                                                                 {"light_angles", 2},
                                                                 {"irradiance", 1, 3},
                                                                 {"lamp", 3},
                                                                 {"intensity", 1, 3},
                                                                 {"lamp_radius", 1},
                                                                 {"light_half_angle", 1},
                                                                 {"white_reflectance", 1},
                                                                 {"white_plane", 6},
                                                                 {"saturation", 1}}};

/// Returns `photograph_entries` and a format's own entries.
template <std::size_t Own>
[[nodiscard]] constexpr auto with_photograph_entries(const std::array<setup_entry, Own>& own) {
  std::array<setup_entry, photograph_entries.size() + Own> all;
  std::ranges::copy(own, std::ranges::copy(photograph_entries, all.begin()).out);
  return all;
}

/// The entries of a file, each at most once, and their lines.
class setup_text {
 public:
  /// `known` lists the possible entries; it must outlive this object.
  setup_text(std::string_view text, const std::string& name, std::span<const setup_entry> known);

  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  [[nodiscard]] const std::vector<double>& numbers(std::string_view name) const { return at(name).rule.numbers; }

  /// Returns an entry's three numbers.
  [[nodiscard]] Eigen::Vector3d vector(std::string_view name) const {
    return Eigen::Vector3d::Map(numbers(name).data());
  }

  /// Returns number `which` of an entry, a whole number of at least `smallest`.
  [[nodiscard]] std::size_t count(std::string_view name, std::size_t which, std::size_t smallest) const;

  [[noreturn]] void refuse(std::string_view name, const std::string& what) const {
    at(name).position.refuse(in_quotes(name) + ": " + what);
  }

  /// Throws gonio::error if the file has none of these entries.
  void require(std::initializer_list<std::string_view> names) const;

  /// Throws gonio::error if the file has both entries, since both define `subject`.
  void require_one_of(std::string_view one, std::string_view other, const std::string& subject) const {
    if (has(one) && has(other))
      refuse(one, in_quotes(other) + " already states " + subject + ", give only one of them");
  }

  /// Calls `act` and adds the file's name to its errors.
  template <class Act>
  auto naming_file(Act&& act) const {
    try {
      return act();
    } catch (const error& refusal) {
      gonio::refuse({name_, ": ", refusal.what()});
    }
  }

 private:
  struct stated_rule {
    text_rule rule;
    text_position position;
  };

  void add(text_rule rule, const text_position& position);

  [[nodiscard]] const stated_rule* find(std::string_view name) const;

  [[nodiscard]] const stated_rule& at(std::string_view name) const;

  std::string name_;
  std::span<const setup_entry> known_;
  std::vector<stated_rule> rules_;
};

/// Returns the camera and its lens. With a calibration the file must give neither size nor lens.
[[nodiscard]] lens_camera setup_camera(const setup_text& text, const std::optional<camera_calibration>& calibration);

[[nodiscard]] capture::surface_light setup_light(const setup_text& text);

/// The entries about the reference in the white image.
struct white_entries {
  std::optional<double> reflectance = {};
  std::optional<capture::placed_plane> plane = {};
};

[[nodiscard]] white_entries setup_white(const setup_text& text);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/setup_text.ipp>
#endif
