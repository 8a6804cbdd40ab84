#pragma once
/// Measurements in the universal BRDF data format of the European metrology institutes: JSON, an object with `metadata`
/// and `data` (EMPIR joint research project 16NRM08 "Bidirectional Reflectance Definitions", BiRD; the schema,
/// version 1.0, and an example are at github.com/BiRD-project/BiRD_view). `data` has an array for each variable:
/// `theta_i`, `phi_i`, `theta_r`, `phi_r`, `BRDF`, perhaps `uBRDF`, wavelengths and polarisations; entry k of each
/// belongs to measurement k.

#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin as such a file does: an object with `metadata` or `data`?
[[nodiscard]] bool looks_like_bird(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it. Measurements at the same directions become one
/// sample: the mean over polarisations and repeats at each wavelength. Where wavelengths differ between pairs of
/// directions they become colours (linear Rec. 709 under D65). The states of illumination must average to unpolarised
/// light (s and p, or opposite Stokes vectors).
///
/// The cone of the receiver is that of `metadata.instrumentation.detection_system.solid_angle`, the cone of the source
/// half of `metadata.instrumentation.illumination_system.beam.divergence` wide, where the file has them.
///
/// A sample's weight is (m / u)^2, from 0.01 to 100, where u is its relative uncertainty (root mean square of what it
/// is a mean of) and m the median of the file's, whatever their coverage factor. Without uncertainty it is 1.
///
/// Throws gonio::error naming what is wrong; also for light that was analysed after reflection, fluorescence, and other
/// variables than these that change within the file: a sample cannot say them.
[[nodiscard]] sample_set read_bird(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_bird(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/bird.ipp>
#endif
