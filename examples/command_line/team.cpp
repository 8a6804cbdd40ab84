#include "command_line/team.hpp"

#include <gonio/io/checked_file.hpp>
#include <gonio/io/file.hpp>

namespace cli {

const team& alone() {
  static const team one;
  return one;
}

std::uint32_t checksum_of(std::span<const std::string> words) {
  std::string all;
  for (const std::string& word : words) all.append(word).push_back('\0');
  return gonio::io::detail::checksum(std::as_bytes(std::span(all)));
}

void agree_on_file(const team& processes, const std::filesystem::path& path, const std::string& what) {
  if (processes.is_alone()) return;
  std::uint32_t checksum = 0;
  processes.together([&] {
    if (!path.empty()) checksum = gonio::io::detail::checksum(gonio::io::read_bytes(path));
  });
  processes.agree_on(checksum, what);
}

}  // namespace cli
