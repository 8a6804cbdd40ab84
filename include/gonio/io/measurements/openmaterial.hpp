#pragma once
/// Look-up tables of reflectance of ASAM OpenMATERIAL 3D (`_brdf.xompt`), which simulations of cameras and lidars read:
/// JSON by the schema `material_brdf_schema.json` of version 1.0.0 (github.com/asam-ev/OpenMATERIAL-3D). `lookupTable`
/// has a row for each wavelength, in metres, zenith angle of the light and of the viewer, and azimuth of the viewer
/// against the light's, in radians, and the BRDF in sr^-1; rows ascend.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// What a file must say of a material beside the numbers. Nobody's licence is guessed: "NOASSERTION" is SPDX's word
/// for one that is not stated.
struct openmaterial_metadata {
  std::string name = "material";
  std::string description = {};  ///< stands before what the numbers are, which is always said
  std::string license = "NOASSERTION";
  std::string author = "not stated", copyright = "not stated";
  std::string sources = "not stated";  ///< measured, simulated, or from literature
};

/// Steps between the rows of a table that is written.
struct openmaterial_steps {
  Eigen::Index polar = 18;    ///< of each zenith angle, from 0 to 90 degrees
  Eigen::Index azimuth = 36;  ///< from 0 to 360 degrees
};

namespace detail {

/// The directions of the rows of one wavelength, in their order. The light's azimuth is 0, the last zenith angle is
/// 1.570796, a little above the horizon. Throws gonio::error for fewer than 1 step or more than 60 and 120 (half a
/// gigabyte).
[[nodiscard]] std::vector<direction_pair> openmaterial_directions(const openmaterial_steps& steps);

/// The file of colours at these directions. Throws gonio::error for a colour that is not finite.
[[nodiscard]] std::string openmaterial_text(const std::vector<rgb>& colours, const openmaterial_steps& steps,
                                            const openmaterial_metadata& metadata);

}  // namespace detail

/// The text of a file. A colour becomes the smooth spectrum of `model::smooth_spectra`, at 20 wavelengths from 380 to
/// 760 nanometres; what is negative becomes 0, the smallest value that the schema has. Same bytes for any number of
/// threads.
template <brdf Brdf>
[[nodiscard]] std::string write_openmaterial(const Brdf& f, const openmaterial_metadata& metadata = {},
                                             const openmaterial_steps& steps = {}, thread_count threads = {}) {
  const std::vector<direction_pair> pairs = detail::openmaterial_directions(steps);
  std::vector<rgb> colours(pairs.size());
  for_each_index(
      std::ssize(pairs), 1024, [&](Eigen::Index i) { colours[i] = f(pairs[i].wi, pairs[i].wo); }, threads);
  return detail::openmaterial_text(colours, steps, metadata);
}

/// Writes a file beside its target and renames it. Throws gonio::error for a name that does not end in `_brdf.xompt`:
/// materials refer to their tables by that ending.
void write_openmaterial(const std::filesystem::path& path, const std::string& text);

/// Does the text begin as such a file does: an object with `openMaterial3dVersion`, or one with `lookupTable`?
[[nodiscard]] bool looks_like_openmaterial(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it. Rows of the same directions become one sample:
/// the mean of those of the same wavelength; samples ascend by their angles. Where wavelengths differ between pairs of
/// directions they become colours (linear Rec. 709 under D65). Rows with a null and directions at the horizon are none.
/// The cone of the receiver is that of the mean of `receiverSolidAngles`, if there are any. Throws gonio::error naming
/// the line of what is wrong, and for tables of other properties. O(rows log rows).
[[nodiscard]] sample_set read_openmaterial(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_openmaterial(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/openmaterial.ipp>
#endif
