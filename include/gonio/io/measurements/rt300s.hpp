#pragma once
/// Measurements exported by the program of J&C's gonio-spectrophotometer RT-300S. Text of the type `BRDF(RT-300S)`
/// (`.jdv`) has a block for each angle of incidence, with a row for each azimuth and a column for each polar angle of
/// the receiver. The program's sheet, saved as text, has a column for each reading, in rows named `Azimuth`,
/// `Incidence`, `Receive` and `RT`. The layouts follow the examples of github.com/ua-loft/bsdf-tools; the angles and
/// the meaning of RT follow its converters.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin like an RT-300S file?
[[nodiscard]] bool looks_like_rt300s(std::string_view text);

/// Reads samples of one value from the text of an RT-300S file. RT is pi times the BRDF times the viewer's cosine; text
/// of the type BRDF(RT-300S) holds 100 RT. The receiver moves in a plane that is turned from the plane of incidence by
/// the azimuth minus 90 degrees: the mirror direction is at a positive angle at azimuth -90, at a negative angle at
/// azimuth 90. Keeps readings in which the receiver shadows the lamp. Throws gonio::error naming the faulty line.
/// Errors call the file `name`.
[[nodiscard]] sample_set read_rt300s(std::string_view text, const std::string& name);

/// Reads an RT-300S file.
[[nodiscard]] sample_set read_rt300s(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/rt300s.ipp>
#endif
