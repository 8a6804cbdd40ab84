#pragma once
/// Pages on paper, as chromium prints them.

#include <filesystem>
#include <string>
#include <string_view>

namespace cli {

/// A word of a command line as a shell takes it.
[[nodiscard]] std::string shell_word(std::string_view word);

/// The name of chromium on the PATH. Throws gonio::error, which names the .pdf, if it is not there.
std::string chromium_for(const std::filesystem::path& pdf);

/// Prints a page, which stands beside its target for so long.
void print_page(const std::filesystem::path& pdf, std::string_view page);

}  // namespace cli
