#include "page_pdf.hpp"

#include <gonio/io/bytes/file.hpp>

#include <unistd.h>

#include <cstdlib>
#include <span>

namespace cli {

std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./=,:+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

std::string chromium_for(const std::filesystem::path& pdf) {
  for (const std::string name : {"chromium", "chromium-browser", "google-chrome"})
    if (std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0) return name;
  gonio::io::refuse_file(pdf, "a .pdf needs chromium on the PATH: install it, or give -o a name that ends in .html");
}

void print_page(const std::filesystem::path& pdf, std::string_view page) {
  const std::string html = std::filesystem::absolute(pdf).string() + ".html", printed = html + ".pdf";
  gonio::io::write_atomically(html, std::as_bytes(std::span(page)));
  // Chromium does not run as root with its sandbox. The page is our own and loads nothing from a network.
  const std::string line = chromium_for(pdf) + " --headless --no-pdf-header-footer " +
                           (::geteuid() == 0 ? "--no-sandbox " : "") + shell_word("--print-to-pdf=" + printed) + ' ' +
                           shell_word(html) + " > /dev/null 2>&1";
  const bool is_printed = std::system(line.c_str()) == 0 && std::filesystem::exists(printed);
  std::filesystem::remove(html);
  if (!is_printed) gonio::io::refuse_file(pdf, "chromium does not print the page");
  std::filesystem::rename(printed, pdf);
}

}  // namespace cli
