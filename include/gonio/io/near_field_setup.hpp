#pragma once
/// Text files that say how an image of a flat sample was taken: a line for each entry, angles in degrees, lengths in
/// any one unit, the sample in the plane z = 0. docs/reference/formats.md has all the entries.
///
/// ```
/// size 640 480           # of the image: columns, rows
/// focal_length 1210.5    # in pixels
/// position 0.5 0 0.3     # of the camera, which looks at the target
/// target 0 0 0
/// light_angles 50 180    # theta, phi of the distant light
/// region 0.1             # radius of the disc that counts
/// ```

#include <gonio/capture/near_field_image.hpp>
#include <gonio/io/rules.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

namespace detail {

/// What a file may say, and with how many numbers; 0: there is no other count.
struct setup_entry {
  std::string_view name;
  std::size_t numbers = 0, or_numbers = 0;
};
inline constexpr std::array<setup_entry, 14> setup_entries{{{"size", 2},
                                                            {"focal_length", 1, 2},
                                                            {"principal_point", 2},
                                                            {"position", 3},
                                                            {"target", 3},
                                                            {"up", 3},
                                                            {"rotation", 9},
                                                            {"light", 3},
                                                            {"light_angles", 2},
                                                            {"irradiance", 1, 3},
                                                            {"region", 1, 3},
                                                            {"window", 4},
                                                            {"saturation", 1},
                                                            {"block", 1}}};

/// The entries of a file, each at most once, and where they are.
class setup_text {
 public:
  /// `known` says which entries there may be.
  setup_text(std::string_view text, const std::string& name, std::span<const setup_entry> known = setup_entries);

  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
  [[nodiscard]] const std::vector<double>& numbers(std::string_view name) const { return at(name).rule.numbers; }

  /// A vector of three numbers of an entry.
  [[nodiscard]] Eigen::Vector3d vector(std::string_view name) const {
    return Eigen::Vector3d::Map(numbers(name).data());
  }

  /// A number that counts something.
  [[nodiscard]] std::size_t count(std::string_view name, std::size_t which, std::size_t smallest) const;

  [[noreturn]] void refuse(std::string_view name, const std::string& what) const {
    at(name).place.refuse(quoted(name) + ": " + what);
  }

  /// Refuses a file with none of these entries.
  void require(std::initializer_list<std::string_view> names) const;

  /// Refuses a file that says in two ways what `subject` is.
  void require_one_of(std::string_view one, std::string_view other, const std::string& subject) const {
    if (has(one) && has(other)) refuse(one, quoted(other) + " says already " + subject + ", give only one of them");
  }

  /// Calls what knows nothing of the file, and names the file where that refuses something.
  template <class Act>
  auto naming_file(Act&& act) const {
    try {
      return act();
    } catch (const error& refusal) {
      gonio::refuse({name_, ": ", refusal.what()});
    }
  }

 private:
  struct placed_rule {
    text_rule rule;
    text_place place;
  };

  void add(text_rule rule, const text_place& place);

  [[nodiscard]] const placed_rule* find(std::string_view name) const;

  [[nodiscard]] const placed_rule& at(std::string_view name) const;

  std::string name_;
  std::span<const setup_entry> known_;
  std::vector<placed_rule> rules_;
};

[[nodiscard]] camera_intrinsics setup_intrinsics(const setup_text& text);

/// The middle of the image unless the file says otherwise.
void set_principal_point(const setup_text& text, camera_intrinsics& intrinsics);

[[nodiscard]] pinhole_camera setup_camera(const setup_text& text, const camera_intrinsics& intrinsics);

[[nodiscard]] directional_light setup_light(const setup_text& text);

[[nodiscard]] capture::near_field_setup make_setup(const setup_text& text);

}  // namespace detail

/// Throws gonio::error naming the line with an entry that is unknown, there twice or not what it should be, or the
/// entry that is missing, and as `require_usable` does; `name` is what errors call the text.
[[nodiscard]] capture::near_field_setup parse_near_field_setup(std::string_view text, const std::string& name);

/// Reads the set-up of an image. Throws gonio::error naming the file and the line.
[[nodiscard]] capture::near_field_setup read_near_field_setup(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/near_field_setup.ipp>
#endif
