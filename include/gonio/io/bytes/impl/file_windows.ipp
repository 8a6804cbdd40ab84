#pragma once
/// Bodies of io/bytes/file.hpp for Windows, which has no files without a name: the temporary file of a killed process
/// stays.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>

#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <system_error>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE descriptor open_to_read(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse_file(path, "is a directory, expected a file");
  descriptor file(::_wopen(path.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT));
  if (!file.is_open()) refuse_file(path, {"cannot be read: ", system_reason(errno)});
  return file;
}

[[gnu::cold]] GONIO_INLINE std::uint64_t size_of_regular(const descriptor& file, const std::filesystem::path& path) {
  struct _stat64 info {};
  if (::_fstat64(file.get(), &info) != 0) refuse_file(path, {"cannot be read: ", system_reason(errno)});
  if (!S_ISREG(info.st_mode)) refuse_file(path, "is not a regular file");
  return static_cast<std::uint64_t>(info.st_size);
}

[[gnu::cold]] GONIO_INLINE std::size_t read_at(const descriptor& file, std::uint64_t offset, std::span<std::byte> bytes,
                                               const std::filesystem::path& path) {
  // All threads that read a file share its position.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (::_lseeki64(file.get(), static_cast<std::int64_t>(offset), SEEK_SET) < 0)
    refuse_file(path, {"cannot be read: ", system_reason(errno)});
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::size_t asked = std::min(bytes.size() - done, std::size_t{1} << 30);
    const int count = ::_read(file.get(), bytes.data() + done, static_cast<unsigned>(asked));
    if (count < 0) refuse_file(path, {"cannot be read: ", system_reason(errno)});
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

/// MinGW's standard library cannot read links, so the written file replaces a link.
[[gnu::cold]] GONIO_INLINE std::filesystem::path follow_links(const std::filesystem::path& path) { return path; }

}  // namespace gonio::io

namespace gonio::io::detail {

inline std::atomic<std::uint32_t> next_temporary{0};

[[gnu::cold]] GONIO_INLINE temporary_name::temporary_name(std::uint32_t given) noexcept : number(given) {
  std::snprintf(text.data(), text.size(), ".gonio-%d-%u.tmp", ::_getpid(), static_cast<unsigned>(number));
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE file_writer::file_writer(const std::filesystem::path& path, staging /*held*/)
    : path_(path), target_(follow_links(path)) {
  inspect_target();
  create_named();
}

[[gnu::cold]] GONIO_INLINE void file_writer::inspect_target() {
  std::error_code ignored;
  const auto status = std::filesystem::status(target_, ignored);
  if (std::filesystem::is_directory(status)) refuse_file(path_, "cannot be written: it is a directory");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    refuse_file(path_, "cannot be written: it is not a regular file");
}

[[gnu::cold]] GONIO_INLINE void file_writer::create_named() {
  // A killed process with this process's number may have left a file of this name.
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary_.emplace(detail::next_temporary++);
    const std::filesystem::path beside = target_.parent_path() / temporary_->c_str();
    constexpr int access = _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT;
    file_ = descriptor(::_wopen(beside.c_str(), access, _S_IREAD | _S_IWRITE));
    if (file_.is_open()) return;
    if (errno != EEXIST) break;
  }
  temporary_.reset();
  fail();
}

[[gnu::cold]] GONIO_INLINE void file_writer::commit() {
  // Windows does not rename an open file.
  if (::_commit(file_.get()) != 0 || !file_.close()) fail();
  std::error_code failed;
  std::filesystem::rename(target_.parent_path() / temporary_->c_str(), target_, failed);
  if (failed) refuse_file(path_, {"cannot be written: ", failed.message()});
  temporary_.reset();
}

[[gnu::cold]] GONIO_INLINE void file_writer::forget_name(bool unlink) noexcept {
  if (!unlink || !temporary_) return;
  file_ = descriptor();
  std::error_code ignored;
  std::filesystem::remove(target_.parent_path() / temporary_->c_str(), ignored);
  temporary_.reset();
}

/// Does nothing: on Windows, a signal handler may call no function that removes a file.
[[gnu::cold]] GONIO_INLINE void remove_unfinished_files() noexcept {}

}  // namespace gonio::io
