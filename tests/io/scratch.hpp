#pragma once
// Common parts of the tests of readers and writers: a temporary folder, and checks that bad input is refused.

#include <gonio/core/error.hpp>

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace scratch {

namespace fs = std::filesystem;

/// An empty folder that is removed with all its content.
class folder {
 public:
  folder() {
    std::string name = (fs::temp_directory_path() / "gonio-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
    path_ = name;
  }
  folder(const folder&) = delete;
  folder& operator=(const folder&) = delete;
  ~folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  [[nodiscard]] const fs::path& path() const { return path_; }
  [[nodiscard]] fs::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::size_t entries() const {
    return std::distance(fs::directory_iterator(path_), fs::directory_iterator());
  }

 private:
  fs::path path_;
};

inline void put(const fs::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  REQUIRE(file.flush());
}

inline void put(const fs::path& path, std::span<const std::byte> content) {
  put(path, std::string(reinterpret_cast<const char*>(content.data()), content.size()));
}

[[nodiscard]] inline std::string get(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

[[nodiscard]] inline std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Checks that `act` throws gonio::error with all these words in its message.
template <class Act>
void check_refused(Act&& act, std::initializer_list<std::string> words) {
  std::string message = "nothing was thrown";
  try {
    static_cast<void>(act());
  } catch (const gonio::error& refusal) {
    message = refusal.what();
  }
  CAPTURE(message);
  for (const std::string& word : words) {
    CAPTURE(word);
    CHECK(message.find(word) != std::string::npos);
  }
}

/// Checks that a reader refuses unreadable files and names the path.
template <class Read>
void check_refuses_non_files(Read&& read) {
  const folder here;
  check_refused([&] { return read(here / "absent.file"); }, {"absent.file", "No such file"});
  fs::create_directory(here / "folder.file");
  check_refused([&] { return read(here / "folder.file"); }, {"folder.file", "is a directory"});
  REQUIRE(::mkfifo((here / "pipe.file").c_str(), 0600) == 0);
  check_refused([&] { return read(here / "pipe.file"); }, {"pipe.file", "not a regular file"});
  put(here / "empty.file", std::string());
  check_refused([&] { return read(here / "empty.file"); }, {"empty.file"});
}

/// Damages valid bytes at random, `rounds` times, and checks that `read` accepts them or throws gonio::error.
/// Sanitizers detect crashes and huge allocations.
template <class Read>
void check_survives_damage(std::span<const std::byte> valid, int rounds, Read&& read) {
  std::mt19937 random(20240229);
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::byte> damaged(valid.begin(), valid.end());
    const std::size_t kind = below(4);
    // Headers are small and matter most: half of the damage is done to the first 64 bytes.
    const std::size_t reach = below(2) == 0 ? damaged.size() : std::min<std::size_t>(damaged.size(), 64);
    if (kind == 0) damaged.resize(below(reach));
    if (kind == 1) damaged[below(reach)] ^= static_cast<std::byte>(1u << below(8));
    if (kind == 2)
      for (std::size_t i = 0; i < 4; ++i) damaged[below(reach)] = static_cast<std::byte>(below(256));
    if (kind == 3) {
      const auto at = damaged.begin() + static_cast<std::ptrdiff_t>(below(reach));
      damaged.insert(at, 1 + below(9), static_cast<std::byte>(below(256)));
    }
    try {
      static_cast<void>(read(std::span<const std::byte>(damaged)));
    } catch (const gonio::error&) {
      ++refused;
    }
  }
  CHECK(refused > 0);
}

}  // namespace scratch
