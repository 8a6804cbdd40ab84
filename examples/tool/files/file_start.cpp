#include "file_start.hpp"

#include <gonio/io/text/text.hpp>

#include <fstream>

namespace cli {

std::string file_start(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string start(65'536, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

std::string lower_extension(const std::filesystem::path& path) {
  return gonio::io::lower_case(path.extension().string());
}

}  // namespace cli
