#pragma once
/// Bodies of io/bytes/file.hpp for POSIX systems.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE descriptor open_to_read(const std::filesystem::path& path) {
  // Without O_NONBLOCK, opening a pipe without a writer would wait forever.
  descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.is_open()) refuse_file(path, {"cannot be read: ", system_reason(errno)});
  return file;
}

[[gnu::cold]] GONIO_INLINE std::uint64_t size_of_regular(const descriptor& file, const std::filesystem::path& path) {
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) refuse_file(path, {"cannot be read: ", system_reason(errno)});
  if (S_ISDIR(info.st_mode)) refuse_file(path, "is a directory, expected a file");
  if (!S_ISREG(info.st_mode)) refuse_file(path, "is not a regular file");
  return static_cast<std::uint64_t>(info.st_size);
}

[[gnu::cold]] GONIO_INLINE std::size_t read_at(const descriptor& file, std::uint64_t offset, std::span<std::byte> bytes,
                                               const std::filesystem::path& path) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pread(file.get(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse_file(path, {"cannot be read: ", system_reason(errno)});
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

[[gnu::cold]] GONIO_INLINE std::filesystem::path follow_links(const std::filesystem::path& path) {
  std::filesystem::path target = path;
  for (int hop = 0; hop < 40; ++hop) {
    std::error_code failed;
    const std::filesystem::path next = std::filesystem::read_symlink(target, failed);
    if (failed) return target;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  refuse_file(path, {"cannot be written: ", system_reason(ELOOP)});
}

}  // namespace gonio::io

namespace gonio::io::detail {

inline constexpr std::string_view temporary_prefix = ".gonio-", temporary_suffix = ".tmp";

inline std::atomic<std::uint32_t> next_temporary{0};

/// This machine's name, with '/' replaced by '_' for use in a file's name. Made without allocation or locks.
class machine_name {
 public:
  machine_name() noexcept {
    if (::uname(&system_) != 0) system_.nodename[0] = '\0';
    std::ranges::replace(system_.nodename, '/', '_');
  }
  explicit(false) operator std::string_view() const noexcept { return system_.nodename; }

 private:
  utsname system_{};
};

[[gnu::cold]] GONIO_INLINE temporary_name::temporary_name(std::uint32_t given) noexcept : number(given) {
  char* at = text.data();
  char* const last = text.data() + text.size() - 1;
  const auto append = [&](std::string_view part) {
    const std::size_t fits = std::min(part.size(), static_cast<std::size_t>(last - at));
    at = std::copy_n(part.data(), fits, at);
  };
  append(temporary_prefix);
  append(machine_name());
  append("-");
  at = std::to_chars(at, last, ::getpid()).ptr;
  append("-");
  at = std::to_chars(at, last, number).ptr;
  append(temporary_suffix);
}

[[gnu::cold]] GONIO_INLINE bool may_be_abandoned(std::string_view name) {
  if (!name.starts_with(temporary_prefix) || !name.ends_with(temporary_suffix)) return false;
  name.remove_prefix(temporary_prefix.size());
  name.remove_suffix(temporary_suffix.size());
  const auto read_number = [&]() -> pid_t {
    const std::size_t begin = name.find_last_of('-') + 1;  // 0 if the name has no '-'
    pid_t number = -1;
    const auto [end, failed] = std::from_chars(name.data() + begin, name.data() + name.size(), number);
    if (failed != std::errc() || end != name.data() + name.size()) return -1;
    name = name.substr(0, begin == 0 ? 0 : begin - 1);
    return number;
  };
  const pid_t number = read_number(), process = read_number();
  if (number < 0 || process <= 0) return false;
  // Names by earlier versions lack the machine.
  if (const machine_name here; !name.empty() && name != std::string_view(here)) return false;
  if (process != ::getpid()) return ::kill(process, 0) != 0 && errno == ESRCH;
  // Keep the files that another thread is writing.
  return std::ranges::none_of(named_temporaries, [&](const auto& slot) {
    const std::uint64_t note = slot.load();
    return note != 0 && static_cast<std::uint32_t>(note & 0xffff'ffffu) == static_cast<std::uint32_t>(number);
  });
}

[[gnu::cold]] GONIO_INLINE void remove_abandoned(const std::filesystem::path& folder, const descriptor& opened) {
  std::error_code failed;
  std::filesystem::directory_iterator entry(folder, failed);
  for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    if (!may_be_abandoned(name)) continue;
    const descriptor file(::openat(opened.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat info {};
    if (!file.is_open() || ::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode)) continue;
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) ::unlinkat(opened.get(), name.c_str(), 0);
  }
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE file_writer::file_writer(const std::filesystem::path& path, staging held)
    : path_(path), target_(follow_links(path)) {
  inspect_target();
  open_folder();
  detail::remove_abandoned(target_.has_parent_path() ? target_.parent_path() : ".", folder_);
  if (held == staging::named || !create_unnamed()) create_named();
  // Marks the file as in use, even for a machine that shares the folder but not the process numbers.
  static_cast<void>(::flock(file_.get(), LOCK_EX | LOCK_NB));
}

[[gnu::cold]] GONIO_INLINE void file_writer::commit() {
  settle();
  const std::filesystem::path name = target_.filename();
  if (!temporary_) {
    if (!replaces_ && link_as(name.c_str())) return;
    // linkat() cannot replace a file, rename() can: link under a temporary name first.
    if (!claim_name([&](const char* beside) { return link_as(beside); })) copy_to_named();
  }
  // Some file systems report a failed write only when a descriptor is closed. Close a copy: file_ keeps the lock.
  if (!descriptor(::dup(file_.get())).close()) fail();
  if (::renameat(folder_.get(), temporary_->c_str(), folder_.get(), name.c_str()) != 0) fail();
  forget_name(false);
}

[[gnu::cold]] GONIO_INLINE void file_writer::settle() {
  // Keep the old file's permissions if the file system has permissions.
  if (replaces_) static_cast<void>(::fchmod(file_.get(), old_mode_));
  // Some file systems have nothing to synchronise, and say EINVAL.
  if (::fsync(file_.get()) != 0 && errno != EINVAL) fail();
}

/// Copies the unnamed file to a named one, in case the file system or a policy refuses to link it.
[[gnu::cold]] GONIO_INLINE void file_writer::copy_to_named() {
  const descriptor unnamed = std::move(file_);
  create_named();
  std::vector<std::byte> block(std::size_t{1} << 16);
  for (off_t at = 0;;) {
    const ssize_t count = ::pread(unnamed.get(), block.data(), block.size(), at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    if (count == 0) break;
    write(std::span(block).first(static_cast<std::size_t>(count)));
    at += count;
  }
  settle();
}

[[gnu::cold]] GONIO_INLINE void file_writer::inspect_target() {
  struct stat info {};
  if (::stat(target_.c_str(), &info) != 0) return;
  if (S_ISDIR(info.st_mode)) refuse_file(path_, "cannot be written: it is a directory");
  if (!S_ISREG(info.st_mode)) refuse_file(path_, "cannot be written: it is not a regular file");
  if (::faccessat(AT_FDCWD, target_.c_str(), W_OK, AT_EACCESS) != 0) fail();
  replaces_ = true;
  old_mode_ = info.st_mode & 07777;
}

[[gnu::cold]] GONIO_INLINE void file_writer::open_folder() {
#if defined(O_PATH)
  constexpr int access = O_PATH;  // a folder may be writable but not listable
#else
  constexpr int access = O_RDONLY;
#endif
  const std::filesystem::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  folder_ = descriptor(::open(folder.c_str(), access | O_DIRECTORY | O_CLOEXEC));
  if (!folder_.is_open()) fail();
}

[[gnu::cold]] GONIO_INLINE bool file_writer::create_unnamed() {
#if defined(O_TMPFILE)
  file_ = descriptor(::openat(folder_.get(), ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
  if (!file_.is_open()) return false;
  // link_as() needs the link in /proc, which may be missing.
  if (::access(message_of({"/proc/self/fd/", file_.get()}).c_str(), F_OK) == 0) return true;
  file_ = descriptor();
#endif
  return false;
}

[[gnu::cold]] GONIO_INLINE void file_writer::create_named() {
  const bool created = claim_name([&](const char* name) {
    file_ = descriptor(::openat(folder_.get(), name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    return file_.is_open();
  });
  if (!created) fail();
}

template <class Claim>
bool file_writer::claim_name(Claim&& claim) {
  // A killed process with this process's number may have left a file of this name that could not be removed.
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary_.emplace(detail::next_temporary++);
    // Note the file's name before the file exists: a signal's handler can then remove the file at any time.
    for (auto& slot : detail::named_temporaries) {
      std::uint64_t free = 0;
      const auto note = (static_cast<std::uint64_t>(folder_.get()) + 1) << 32 | temporary_->number;
      if (!slot.compare_exchange_strong(free, note)) continue;
      noted_ = &slot;
      break;
    }
    if (claim(temporary_->c_str())) return true;
    const int reason = errno;
    forget_name(false);
    errno = reason;
    if (reason != EEXIST) break;
  }
  return false;
}

[[gnu::cold]] GONIO_INLINE void file_writer::forget_name(bool unlink) noexcept {
  if (unlink && temporary_) ::unlinkat(folder_.get(), temporary_->c_str(), 0);
  temporary_.reset();
  if (noted_ != nullptr) noted_->store(0);
  noted_ = nullptr;
}

[[gnu::cold]] GONIO_INLINE bool file_writer::link_as(const char* name) const noexcept {
  std::array<char, 32> self{"/proc/self/fd/"};
  std::to_chars(self.data() + std::strlen(self.data()), self.data() + self.size() - 1, file_.get());
  return ::linkat(AT_FDCWD, self.data(), folder_.get(), name, AT_SYMLINK_FOLLOW) == 0;
}

[[gnu::cold]] GONIO_INLINE void remove_unfinished_files() noexcept {
  for (const auto& slot : detail::named_temporaries)
    if (const std::uint64_t note = slot.load(); note != 0)
      ::unlinkat(static_cast<int>(note >> 32) - 1,
                 detail::temporary_name(static_cast<std::uint32_t>(note & 0xffff'ffffu)).c_str(), 0);
}

}  // namespace gonio::io
