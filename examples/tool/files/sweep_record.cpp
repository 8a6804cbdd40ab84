#include "sweep_record.hpp"

#include <gonio/core/error.hpp>

#include <cerrno>
#include <charconv>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace cli {

namespace {

/// Returns the complete lines; a killed run may have left half a line.
std::string whole_lines(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  return all.substr(0, all.rfind('\n') + 1);
}

/// Returns nothing unless the text is lines of numbers.
std::vector<Eigen::Index> numbers_in(std::string_view text) {
  std::vector<Eigen::Index> numbers;
  while (!text.empty()) {
    Eigen::Index number = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0 || end == text.data() + text.size() || *end != '\n') return {};
    numbers.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  }
  return numbers;
}

}  // namespace

sweep_record::sweep_record(const std::filesystem::path& output, std::uint32_t checksum, const team& processes)
    : head_("gonio design, sweeps of " + std::to_string(checksum) + '\n'), writes_(processes.writes()) {
  std::error_code none;
  const auto target = std::filesystem::status(output, none);
  if (std::filesystem::exists(target) && !std::filesystem::is_regular_file(target)) return;
  path_ = output;
  path_ += ".part";
  std::string text;
  processes.together([&] {
    if (!writes_) return;
    text = whole_lines(path_);
    if (!text.empty() && !text.starts_with(head_))
      gonio::refuse({path_.string(), ": was begun with other inputs or options: remove it, or give another -o"});
    if (!text.empty()) text.erase(0, head_.size());
  });
  earlier_ = numbers_in(processes.text_of_writer(std::move(text)));
}

Eigen::Index sweep_record::next(const std::function<Eigen::Index()>& sweep, Eigen::Index candidates) {
  if (done_ < earlier_.size()) {
    const Eigen::Index known = earlier_[done_++];
    if (known >= candidates)
      gonio::refuse({path_.string(), ": names candidate ", known, ", but the last candidate is ", candidates - 1,
                     ": remove the file"});
    return known;
  }
  const Eigen::Index best = sweep();
  if (writes_ && !path_.empty()) append(best);
  return best;
}

void sweep_record::append(Eigen::Index best) {
  if (!file_.is_open()) {
    file_.open(path_, std::ios::binary | std::ios::trunc);  // the content read before is written again
    file_ << head_;
    for (const Eigen::Index number : earlier_) file_ << number << '\n';
  }
  file_ << best << std::endl;
  if (!file_) gonio::refuse({path_.string(), ": cannot be written: ", std::generic_category().message(errno)});
}

void sweep_record::remove() {
  if (!writes_ || path_.empty()) return;
  file_.close();
  std::error_code none;
  std::filesystem::remove(path_, none);
}

}  // namespace cli
