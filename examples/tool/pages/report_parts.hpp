#pragma once
/// The files of examples/report/ as text, in pieces short enough for all compilers. CMake writes the source.

#include <span>
#include <string_view>

namespace cli {

[[nodiscard]] std::span<const std::string_view> report_form();    ///< page.html
[[nodiscard]] std::span<const std::string_view> report_style();   ///< style.css
[[nodiscard]] std::span<const std::string_view> report_bundle();  ///< bundle.js
[[nodiscard]] std::span<const std::string_view> report_script();  ///< tables.js to report.js

}  // namespace cli
