#pragma once
/// Measurements of J&C's gonio-spectrophotometer RT-300S as its program exports them: text of the type
/// `BRDF(RT-300S)` (`.jdv`), a block for each angle of incidence with a row for each azimuth and a column for each
/// polar angle of the receiver; and its sheet, saved as text, a column for each reading below the names `Azimuth`,
/// `Incidence`, `Receive` and `RT`. Layouts as in the examples of github.com/ua-loft/bsdf-tools, angles and the meaning
/// of RT as in its converters.

#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text begin as such a file does?
[[nodiscard]] bool looks_like_rt300s(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it: one value. RT is pi times the BRDF times the
/// viewer's cosine; text of the type BRDF(RT-300S) has 100 RT. The receiver moves in a plane that is turned by the
/// azimuth minus 90 degrees from that of incidence: at azimuth -90 the mirror direction is at a positive angle, at 90
/// at a negative one. Readings in which the receiver stands before the lamp stay in. Throws gonio::error naming the
/// line of what is wrong.
[[nodiscard]] sample_set read_rt300s(std::string_view text, const std::string& name);

/// Reads such a file.
[[nodiscard]] sample_set read_rt300s(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/rt300s.ipp>
#endif
