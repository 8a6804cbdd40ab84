#pragma once
/// Pages as PDF, printed by chromium.

#include <filesystem>
#include <string>
#include <string_view>

namespace cli {

/// Returns a word of a command line, quoted for a shell if necessary.
[[nodiscard]] std::string shell_word(std::string_view word);

/// Returns the name of chromium on the PATH. Throws gonio::error naming the .pdf if chromium is not there.
std::string chromium_for(const std::filesystem::path& pdf);

/// Prints a page to a .pdf. While it is printed, the page is in an .html file beside the .pdf.
void print_page(const std::filesystem::path& pdf, std::string_view page);

}  // namespace cli
