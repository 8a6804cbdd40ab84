#pragma once
/// Bodies of io/file.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE std::string system_reason(int code) { return std::generic_category().message(code); }

GONIO_INLINE void refuse_file(const std::filesystem::path& path, std::initializer_list<message_part> what) {
  throw error{path.native(), ": ", message_of(what)};
}

GONIO_INLINE std::filesystem::path follow_links(const std::filesystem::path& path) {
  std::filesystem::path target = path;
  for (int hop = 0; hop < 40; ++hop) {
    std::error_code failed;
    const std::filesystem::path next = std::filesystem::read_symlink(target, failed);
    if (failed) return target;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  refuse_file(path, {"cannot be written: ", system_reason(ELOOP)});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  // Without O_NONBLOCK, opening a pipe that nobody writes to would wait forever.
  const detail::descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (!file.is_open() || ::fstat(file.get(), &info) != 0)
    detail::refuse_file(path, {"cannot be read: ", detail::system_reason(errno)});
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
    if (count < 0) detail::refuse_file(path, {"cannot be read: ", detail::system_reason(errno)});
    if (count == 0) detail::refuse_file(path, "became shorter while it was read");
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

GONIO_INLINE file_writer::file_writer(const std::filesystem::path& path)
    : path_(path), target_(detail::follow_links(path)) {
  inspect_target();
  create_temporary();
}

GONIO_INLINE void file_writer::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_.get(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

GONIO_INLINE void file_writer::commit() {
  // The old file's permissions are kept where the file system knows such a thing.
  if (replaces_) static_cast<void>(::fchmod(file_.get(), old_mode_));
  // Some file systems have nothing to synchronise, and say EINVAL.
  if (::fsync(file_.get()) != 0 && errno != EINVAL) fail();
  if (!file_.close()) fail();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail();
  temporary_.clear();
}

GONIO_INLINE void file_writer::fail() const {
  detail::refuse_file(path_, {"cannot be written: ", detail::system_reason(errno)});
}

GONIO_INLINE void file_writer::inspect_target() {
  struct stat info {};
  if (::stat(target_.c_str(), &info) != 0) return;
  if (S_ISDIR(info.st_mode)) detail::refuse_file(path_, "cannot be written: it is a directory");
  if (!S_ISREG(info.st_mode)) detail::refuse_file(path_, "cannot be written: it is not a regular file");
  if (::faccessat(AT_FDCWD, target_.c_str(), W_OK, AT_EACCESS) != 0) fail();
  replaces_ = true;
  old_mode_ = info.st_mode & 07777;
}

GONIO_INLINE void file_writer::create_temporary() {
  const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  const std::string stem = message_of({(folder / ".gonio-").native(), ::getpid(), "-"});
  // Another thread, or a process of this number that crashed, may have taken a name.
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::string candidate = message_of({stem, attempt, ".tmp"});
    file_ = detail::descriptor(::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file_.is_open()) {
      temporary_ = candidate;
      return;
    }
    if (errno != EEXIST) break;
  }
  fail();
}

GONIO_INLINE void write_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  file_writer file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace gonio::io
