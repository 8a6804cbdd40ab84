#pragma once
/// Files as bytes: reading one whole, and replacing one so that whoever reads it meanwhile sees the old
/// content or the new, never a part. Every failure is a gonio::error that names the path and the system's
/// reason. POSIX.

#include <gonio/core/error.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace gonio::io {

namespace detail {

[[nodiscard]] inline std::string system_reason(int code) { return std::generic_category().message(code); }

[[noreturn]] inline void refuse_file(const std::filesystem::path& path, const std::string& what) {
  throw error(path.string() + ": " + what);
}

/// Owns an open file.
class descriptor {
 public:
  explicit descriptor(int number = -1) noexcept : number_(number) {}
  descriptor(descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  descriptor& operator=(descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~descriptor() {
    if (is_open()) ::close(number_);
  }

  [[nodiscard]] bool is_open() const noexcept { return number_ >= 0; }
  [[nodiscard]] int get() const noexcept { return number_; }
  /// For a file that was written: some file systems report a failed write only here.
  [[nodiscard]] bool close() noexcept { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// What a path's symbolic links lead to, be it there or not, so that a link stays a link when written.
[[nodiscard]] inline std::filesystem::path follow_links(const std::filesystem::path& path) {
  std::filesystem::path target = path;
  for (int hop = 0; hop < 40; ++hop) {
    std::error_code failed;
    const std::filesystem::path next = std::filesystem::read_symlink(target, failed);
    if (failed) return target;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  refuse_file(path, "cannot be written: " + system_reason(ELOOP));
}

}  // namespace detail

/// The whole content of a regular file.
[[nodiscard]] inline std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  // Without O_NONBLOCK, opening a pipe that nobody writes to would wait forever.
  const detail::descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (!file.is_open() || ::fstat(file.get(), &info) != 0)
    detail::refuse_file(path, "cannot be read: " + detail::system_reason(errno));
  if (S_ISDIR(info.st_mode)) detail::refuse_file(path, "is a directory, expected a file");
  if (!S_ISREG(info.st_mode)) detail::refuse_file(path, "is not a regular file");

  std::vector<std::byte> bytes;
  try {
    bytes.resize(static_cast<std::size_t>(info.st_size));
  } catch (const std::bad_alloc&) {
    detail::refuse_file(path, "is too large for this machine's memory");
  } catch (const std::length_error&) {
    detail::refuse_file(path, "is too large for this machine's memory");
  }
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) detail::refuse_file(path, "cannot be read: " + detail::system_reason(errno));
    if (count == 0) detail::refuse_file(path, "became shorter while it was read");
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

/// The file that the callback of `write_atomically` fills.
class file_writer {
 public:
  /// Opens a temporary file beside the target. Prefer `write_atomically`, which cannot be left halfway.
  explicit file_writer(const std::filesystem::path& path) : path_(path), target_(detail::follow_links(path)) {
    inspect_target();
    create_temporary();
  }
  file_writer(const file_writer&) = delete;
  file_writer& operator=(const file_writer&) = delete;
  ~file_writer() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  /// Appends bytes; throws gonio::error naming the target and the reason where they cannot be stored.
  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(file_.get(), bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail();
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }

  /// Puts what was written in the target's place. Nothing may be written afterwards.
  void commit() {
    // The old file's permissions are kept where the file system knows such a thing.
    if (replaces_) static_cast<void>(::fchmod(file_.get(), old_mode_));
    // Some file systems have nothing to synchronise, and say EINVAL.
    if (::fsync(file_.get()) != 0 && errno != EINVAL) fail();
    if (!file_.close()) fail();
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail();
    temporary_.clear();
  }

 private:
  /// rename() would replace a read-only file, or a device like /dev/null, without a word.
  void inspect_target() {
    struct stat info {};
    if (::stat(target_.c_str(), &info) != 0) return;
    if (S_ISDIR(info.st_mode)) detail::refuse_file(path_, "cannot be written: it is a directory");
    if (!S_ISREG(info.st_mode)) detail::refuse_file(path_, "cannot be written: it is not a regular file");
    if (::faccessat(AT_FDCWD, target_.c_str(), W_OK, AT_EACCESS) != 0) fail();
    replaces_ = true;
    old_mode_ = info.st_mode & 07777;
  }

  void create_temporary() {
    const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
    const std::string stem = ".gonio-" + std::to_string(::getpid()) + "-";
    // Another thread, or a process of this number that crashed, may have taken a name.
    for (int attempt = 0; attempt < 1000; ++attempt) {
      const std::filesystem::path candidate = folder / (stem + std::to_string(attempt) + ".tmp");
      file_ = detail::descriptor(::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
      if (file_.is_open()) {
        temporary_ = candidate;
        return;
      }
      if (errno != EEXIST) break;
    }
    fail();
  }

  [[noreturn]] void fail() const { detail::refuse_file(path_, "cannot be written: " + detail::system_reason(errno)); }

  std::filesystem::path path_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;
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
inline void write_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  write_atomically(path, [&](file_writer& file) { file.write(bytes); });
}

}  // namespace gonio::io
