#pragma once
/// Look-up tables of reflectance of ASAM OpenMATERIAL 3D (`_brdf.xompt`), for simulations of cameras and lidars: JSON
/// by the schema `material_brdf_schema.json` of version 1.0.0 (github.com/asam-ev/OpenMATERIAL-3D). A row of
/// `lookupTable` has wavelength in metres, zenith angles of light and viewer and azimuth of the viewer relative to the
/// light's, in radians, and the BRDF in sr^-1; rows ascend.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// The required description of a material. No licence is guessed: "NOASSERTION" is SPDX's word for an unstated one.
struct openmaterial_metadata {
  std::string name = "material";
  std::string description = {};  ///< comes before the meaning of the numbers, which is always written
  std::string license = "NOASSERTION";
  std::string author = "not stated", copyright = "not stated";
  std::string sources = "not stated";  ///< measured, simulated, or from literature
};

/// Numbers of steps between the angles of a written table.
struct openmaterial_steps {
  Eigen::Index polar = 18;    ///< steps of each zenith angle, from 0 to 90 degrees
  Eigen::Index azimuth = 36;  ///< steps of the azimuth, from 0 to 360 degrees
};

namespace detail {

/// Returns the directions of the rows of one wavelength, in their order. The light's azimuth is 0; the last zenith
/// angle is 1.570796, just above the horizon. Throws gonio::error for fewer than 1 step, and for more than 60 polar or
/// 120 azimuthal steps (half a gigabyte).
[[nodiscard]] std::vector<direction_pair> openmaterial_directions(const openmaterial_steps& steps);

/// Returns the text of a file with these colours, in the order of `openmaterial_directions`. Refuses NaN and infinity.
[[nodiscard]] std::string openmaterial_text(const std::vector<rgb>& colours, const openmaterial_steps& steps,
                                            const openmaterial_metadata& metadata);

}  // namespace detail

/// Returns the text of a file. A colour becomes the smooth spectrum of `model::smooth_spectra`, at 20 wavelengths from
/// 380 to 760 nanometres; negative values become 0, the schema's minimum. Any number of threads gives the same bytes.
template <brdf Brdf>
[[nodiscard]] std::string write_openmaterial(const Brdf& f, const openmaterial_metadata& metadata = {},
                                             const openmaterial_steps& steps = {}, thread_count threads = {}) {
  const std::vector<direction_pair> pairs = detail::openmaterial_directions(steps);
  std::vector<rgb> colours(pairs.size());
  for_each_index(
      std::ssize(pairs), 1024, [&](Eigen::Index i) { colours[i] = f(pairs[i].wi, pairs[i].wo); }, threads);
  return detail::openmaterial_text(colours, steps, metadata);
}

/// Writes a file beside its target and renames it. Throws gonio::error for a name that does not end in `_brdf.xompt`,
/// the ending by which materials refer to their tables.
void write_openmaterial(const std::filesystem::path& path, const std::string& text);

/// Is the text a JSON object with `openMaterial3dVersion` or `lookupTable`?
[[nodiscard]] bool looks_like_openmaterial(std::string_view text);

/// Reads samples from the text of an OpenMATERIAL file, in ascending order of their angles. Rows with the same
/// directions become one sample; rows with the same directions and wavelength are averaged. If wavelengths differ
/// between pairs of directions, samples become colours (linear Rec. 709 under D65). Skips rows with a null and
/// directions at the horizon. The mean of `receiverSolidAngles`, if there are any, gives the cone of the receiver.
/// Throws gonio::error naming the faulty line, and for tables of other properties. Errors call the file `name`. O(rows
/// log rows).
[[nodiscard]] sample_set read_openmaterial(std::string_view text, const std::string& name);

/// Reads an OpenMATERIAL file.
[[nodiscard]] sample_set read_openmaterial(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/openmaterial.ipp>
#endif
