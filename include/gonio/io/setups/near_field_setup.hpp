#pragma once
/// Text files that describe how an image of a flat sample was taken. A line for each entry, angles in degrees, lengths
/// in any one unit, the sample in the plane z = 0. docs/reference/formats.md lists all entries.
///
/// ```
/// size 640 480           # columns and rows of the image
/// focal_length 1210.5    # in pixels
/// position 0.5 0 0.3     # of the camera, which looks at the target
/// target 0 0 0
/// light_angles 50 180    # theta, phi of a distant light; for a lamp, give lamp x y z instead
/// region 0.1             # radius of the evaluated disc
/// ```

#include <gonio/capture/near_field_image.hpp>
#include <gonio/io/setups/camera_calibration.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

/// Reads the set-up of an image. Throws gonio::error naming the line if an entry is unknown, repeated or wrong, naming
/// the entry if one is missing, and as `require_usable` does. With a calibration the text must give neither size nor
/// lens. Errors call the text `name`.
[[nodiscard]] capture::near_field_setup read_near_field_setup(
    std::string_view text, const std::string& name, const std::optional<camera_calibration>& calibration = {});

/// Reads a set-up file.
[[nodiscard]] capture::near_field_setup read_near_field_setup(
    const std::filesystem::path& path, const std::optional<camera_calibration>& calibration = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/near_field_setup.ipp>
#endif
