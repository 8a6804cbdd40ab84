#include "team.hpp"

#include "shipped_data.hpp"
#include <gonio/io/bytes/checked_file.hpp>

#include <algorithm>
#include <future>
#include <utility>

namespace cli {

team::part bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string text_of(const team::part& bytes) {
  std::string text(bytes.size(), ' ');
  std::ranges::transform(bytes, text.begin(), [](std::byte each) { return std::to_integer<char>(each); });
  return text;
}

const team& alone() {
  static const team one;
  return one;
}

std::uint32_t checksum_of(std::span<const std::string> words) {
  std::string all;
  for (const std::string& word : words) all.append(word).push_back('\0');
  return gonio::io::checksum(std::as_bytes(std::span(all)));
}

void team::compute_in_order(gonio::block range, const std::function<part(Eigen::Index)>& compute,
                            const std::function<void(Eigen::Index, part)>& take) const {
  // The future's destructor waits: no computation outlives this function.
  std::future<part> ahead;
  const auto begin = [&](Eigen::Index i) {
    if (i < range.end) ahead = std::async(std::launch::async, [&compute, i] { return compute(i); });
  };
  begin(range.begin);
  for (Eigen::Index i = range.begin; i < range.end; ++i) {
    part own = ahead.get();
    begin(i + 1);
    take(i, std::move(own));
  }
}

void agree_on_file(const team& processes, const std::filesystem::path& path, const std::string& what) {
  if (processes.is_alone()) return;
  std::uint32_t checksum = 0;
  processes.together([&] {
    if (!path.empty()) checksum = gonio::io::checksum(read_input(path));
  });
  processes.agree_on(checksum, what);
}

}  // namespace cli
