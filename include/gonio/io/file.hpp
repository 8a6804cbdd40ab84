#pragma once
/// Files as bytes: reading one whole, and replacing one so that whoever reads it meanwhile sees the old
/// content or the new, never a part. Every failure is a gonio::error that names the path and the system's
/// reason. POSIX.

#include <gonio/core/error.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <concepts>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io {

namespace detail {

[[nodiscard]] std::string system_reason(int code);

/// The parts of the message, one after the other.
[[noreturn]] void refuse_file(const std::filesystem::path& path, std::initializer_list<message_part> what);
[[noreturn]] inline void refuse_file(const std::filesystem::path& path, const message_part& what) {
  refuse_file(path, {what});
}

/// Owns an open file.
class descriptor {
 public:
  explicit descriptor(int number = -1) noexcept : number_(number) {}
  descriptor(descriptor&& other) noexcept : number_(other.release()) {}
  descriptor& operator=(descriptor&& other) noexcept {
    const int mine = number_;
    number_ = other.number_;
    other.number_ = mine;
    return *this;
  }
  ~descriptor() {
    if (is_open()) ::close(number_);
  }

  [[nodiscard]] bool is_open() const noexcept { return number_ >= 0; }
  [[nodiscard]] int get() const noexcept { return number_; }
  /// For a file that was written: some file systems report a failed write only here.
  [[nodiscard]] bool close() noexcept { return ::close(release()) == 0; }

 private:
  [[nodiscard]] int release() noexcept {
    const int number = number_;
    number_ = -1;
    return number;
  }

  int number_;
};

/// What a path's symbolic links lead to, be it there or not, so that a link stays a link when written.
[[nodiscard]] std::filesystem::path follow_links(const std::filesystem::path& path);

}  // namespace detail

/// The whole content of a regular file.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// The file that the callback of `write_atomically` fills.
class file_writer {
 public:
  /// Opens a temporary file beside the target. Prefer `write_atomically`, which cannot be left halfway.
  explicit file_writer(const std::filesystem::path& path);
  file_writer(const file_writer&) = delete;
  file_writer& operator=(const file_writer&) = delete;
  ~file_writer() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  /// Appends bytes; throws gonio::error naming the target and the reason where they cannot be stored.
  void write(std::span<const std::byte> bytes);

  /// Puts what was written in the target's place. Nothing may be written afterwards.
  void commit();

 private:
  /// rename() would replace a read-only file, or a device like /dev/null, without a word.
  void inspect_target();

  void create_temporary();

  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path target_;
  std::string temporary_;
  detail::descriptor file_;
  bool replaces_ = false;
  mode_t old_mode_ = 0;
};

/// Calls `fill(file_writer&)` and then replaces the file. If anything fails, the callback included, the old
/// file is whole and nothing is left beside it.
template <std::invocable<file_writer&> Fill>
void write_atomically(const std::filesystem::path& path, Fill&& fill) {
  file_writer file(path);
  std::forward<Fill>(fill)(file);
  file.commit();
}

/// Replaces the file by these bytes.
void write_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/file.ipp>
#endif
