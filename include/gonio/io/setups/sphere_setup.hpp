#pragma once
/// Text files that describe how a sphere or another known surface was photographed, with the entries of
/// io/setups/setup_text.hpp: a line for each entry, lengths in any one unit. All entries: docs/reference/formats.md.
///
/// ```
/// size 640 480             # columns and rows of the image
/// field_of_view 20         # degrees from left to right; or give focal_length in pixels
/// distortion -0.2 0.05 0 0 # k1 k2 p1 p2 [k3]
/// position 0 0 0.6         # of the camera, which looks at the target
/// target 0 0 0
/// lamp 0.5 0.2 0.7         # its position; for a distant light, give its direction as light x y z instead
/// sphere 0.05              # its radius, and its centre if known
/// white_reflectance 0.98   # of the reference in the white image
/// ```

#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/io/setups/camera_calibration.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

/// The set-up of a photograph of a known surface.
struct sphere_setup {
  lens_camera camera;
  capture::surface_light light;
  std::optional<double> radius = {};                    ///< of a sphere
  std::optional<Eigen::Vector3d> centre = {};           ///< of the sphere; none: found from the photograph
  std::optional<capture::outline_circle> outline = {};  ///< drawn by hand, used instead of the photograph's edges
  std::optional<double> white_reflectance = {};
  std::optional<capture::placed_plane> white_plane = {};  ///< none: the reference has the shape of the surface
  capture::photograph_options options = {};
};

/// Reads a set-up. Throws gonio::error naming the line if an entry is unknown, repeated or wrong, or naming the entry
/// if one is missing. With a calibration the text must give neither size nor lens. Errors call the text `name`.
[[nodiscard]] sphere_setup read_sphere_setup(std::string_view text, const std::string& name,
                                             const std::optional<camera_calibration>& calibration = {});

/// Reads a set-up file.
[[nodiscard]] sphere_setup read_sphere_setup(const std::filesystem::path& path,
                                             const std::optional<camera_calibration>& calibration = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/sphere_setup.ipp>
#endif
