#pragma once
// What the harnesses of the readers share. A harness is one file: a function that reads bytes as its format, and a
// `fuzz::registered` that names it. libfuzzer/driver.cpp runs the one that it is linked with; tests/crafted runs all.

#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/table/sample_set.hpp>

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fuzz {

using input = std::span<const std::byte>;

/// Reads the bytes, whatever they are, or throws gonio::error.
using read_function = void (*)(input bytes);

struct reader {
  std::string name;
  read_function read;
};

[[nodiscard]] inline std::vector<reader>& readers() {
  static std::vector<reader> all;
  return all;
}

struct registered {
  registered(const std::string& name, read_function read) { readers().push_back({name, read}); }
};

/// What harnesses call bytes that are no file.
inline const std::string bytes_name = "fuzzed.file";

[[nodiscard]] inline std::string_view text_of(input bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The bytes as a file that is nowhere on a disk, for readers that take a path.
class memory_file {
 public:
  /// Readers that look at a file's extension need a name: a link in the temporary folder.
  explicit memory_file(input bytes, const std::string& extension = "") : file_(::memfd_create("fuzzed", 0)) {
    if (file_ < 0) throw std::runtime_error("no file in memory");
    for (input left = bytes; !left.empty();) {
      const ssize_t count = ::write(file_, left.data(), left.size());
      if (count <= 0) throw std::runtime_error("no room for a file in memory");
      left = left.subspan(count);
    }
    path_ = "/proc/self/fd/" + std::to_string(file_);
    if (extension.empty()) return;
    const std::string number = std::to_string(::getpid());
    link_ = std::filesystem::temp_directory_path() / ("fuzzed.file-" + number + extension);
    std::filesystem::remove(link_);
    std::filesystem::create_symlink("/proc/" + number + "/fd/" + std::to_string(file_), link_);
  }
  memory_file(const memory_file&) = delete;
  memory_file& operator=(const memory_file&) = delete;
  ~memory_file() {
    ::close(file_);
    if (!link_.empty()) ::unlink(link_.c_str());
  }

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return link_.empty() ? path_ : link_; }

 private:
  int file_;
  std::filesystem::path path_, link_;
};

/// What is wrong with a refusal, or nothing: it must name the file, and hold nothing that steers a terminal.
[[nodiscard]] inline std::string fault_of(const gonio::error& refusal) {
  const std::string message = refusal.what();
  if (gonio::printable(message) != message) return "the message holds control characters: " + gonio::printable(message);
  for (const std::string& name : {bytes_name, std::string("/proc/self/fd/")})
    if (message.find(name) != std::string::npos) return "";
  return "the message does not name the file: " + message;
}

}  // namespace fuzz
