#pragma once
/// Measurements in the universal BRDF data format of the European metrology institutes: JSON, an object with `metadata`
/// and `data` (EMPIR joint research project 16NRM08 "Bidirectional Reflectance Definitions", BiRD; the schema, version
/// 1.0, and an example are at github.com/BiRD-project/BiRD_view). `data` has an array for each variable: `theta_i`,
/// `phi_i`, `theta_r`, `phi_r`, `BRDF`, optionally `uBRDF`, wavelengths and polarisations. Entry k of each array
/// belongs to measurement k.

#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Is the text a JSON object with `metadata` or `data`?
[[nodiscard]] bool looks_like_bird(std::string_view text);

/// Reads samples from the text of a BiRD file. Measurements with the same directions become one sample: the mean over
/// polarisations and repeats at each wavelength. If wavelengths differ between pairs of directions, samples become
/// colours (linear Rec. 709 under D65). The states of illumination must average to unpolarised light (s and p, or
/// opposite Stokes vectors). Errors call the file `name`.
///
/// If the file has them, `metadata.instrumentation.detection_system.solid_angle` gives the cone of the receiver, and
/// half of `metadata.instrumentation.illumination_system.beam.divergence` the cone of the source.
///
/// A sample's weight is (m / u)^2, clamped to 0.01 to 100. Here u is the sample's relative uncertainty (root mean
/// square over the averaged measurements) and m the file's median of u: the coverage factor cancels. Without
/// uncertainty the weight is 1.
///
/// Throws gonio::error naming the fault; also for light analysed after reflection, for fluorescence, and if other
/// variables change within the file, because a sample cannot hold them.
[[nodiscard]] sample_set read_bird(std::string_view text, const std::string& name);

/// Reads a BiRD file.
[[nodiscard]] sample_set read_bird(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/bird.ipp>
#endif
