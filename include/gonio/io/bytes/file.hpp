#pragma once
/// Files as bytes: reads a whole file, and replaces a file so that a concurrent reader sees either the old content or
/// the new, never a part. Every failure is a gonio::error that names the path and the system's reason. If the system
/// has unnamed files, a killed process leaves nothing behind (docs/decisions/0017-unfinished-files.md). For POSIX, and
/// for Windows with MinGW, which has no unnamed files.

#include <gonio/core/error.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io {

/// Returns the system's text for an error number: "No such file or directory".
[[nodiscard]] std::string system_reason(int code);

/// Throws gonio::error with the file's path and the joined parts of the message.
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
  /// Closes the file; returns false if that fails. Call it after writing: some file systems report a failed write only
  /// here.
  [[nodiscard]] bool close() noexcept { return ::close(release()) == 0; }

 private:
  [[nodiscard]] int release() noexcept {
    const int number = number_;
    number_ = -1;
    return number;
  }

  int number_;
};

/// Opens a file to read; does not wait for the writer of a pipe. Throws gonio::error if it cannot be opened.
[[nodiscard]] descriptor open_to_read(const std::filesystem::path& path);

/// Returns the file's size in bytes. Throws gonio::error unless it is a regular file.
[[nodiscard]] std::uint64_t size_of_regular(const descriptor& file, const std::filesystem::path& path);

/// Reads from an offset until `bytes` is full or the file ends; returns the number of bytes read. Throws gonio::error
/// if reading fails.
[[nodiscard]] std::size_t read_at(const descriptor& file, std::uint64_t offset, std::span<std::byte> bytes,
                                  const std::filesystem::path& path);

/// Writes all bytes at the file's position. Returns false and sets errno if they cannot be stored.
[[nodiscard]] bool write_all(const descriptor& file, std::span<const std::byte> bytes) noexcept;

/// Returns the file that a path's symbolic links lead to; it need not exist. Replacing that file keeps the links.
[[nodiscard]] std::filesystem::path follow_links(const std::filesystem::path& path);

namespace detail {

/// The name of a temporary file: machine, process and a number. Made without allocation or locks.
struct temporary_name {
  explicit temporary_name(std::uint32_t number) noexcept;
  [[nodiscard]] const char* c_str() const noexcept { return text.data(); }

  std::uint32_t number;
  std::array<char, 128> text{};
};

/// This process's named temporary files. An entry's high half is the folder's descriptor plus 1, its low half the
/// file's number; 0 is a free entry. If there are more than 64 files, remove_unfinished_files does not remove those
/// without an entry.
inline std::array<std::atomic<std::uint64_t>, 64> named_temporaries{};

/// Is this the name of a temporary file of an ended process of this machine, or of this process but not among
/// `named_temporaries`?
[[nodiscard]] bool may_be_abandoned(std::string_view name);

/// Removes the temporary files of a folder (open as `opened`) that no process holds. Files that cannot be removed stay.
void remove_abandoned(const std::filesystem::path& folder, const descriptor& opened);

}  // namespace detail

/// Returns the whole content of a regular file.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// Where the bytes of a file are kept until it is committed.
enum class staging {
  unnamed,  ///< a file without a name, which vanishes with its process; `named` if the system has no such files
  named     ///< a file `.gonio-HOST-PROCESS-NUMBER.tmp` beside the target, locked while its process lives
};

/// The file that the callback of `write_atomically` fills.
class file_writer {
 public:
  /// Opens a temporary file in the target's folder. Removes the temporary files that killed processes left there,
  /// except on Windows. Prefer `write_atomically`, which commits by itself.
  explicit file_writer(const std::filesystem::path& path, staging held = staging::unnamed);
  file_writer(const file_writer&) = delete;
  file_writer& operator=(const file_writer&) = delete;
  ~file_writer() { forget_name(true); }

  /// Appends bytes; throws gonio::error naming the target and the reason if they cannot be stored.
  void write(std::span<const std::byte> bytes);

  /// Replaces the target with the bytes written. Write nothing afterwards.
  void commit();

 private:
  /// Refuses a read-only file or a device such as /dev/null, which rename() would silently replace.
  void inspect_target();

  void open_folder();
  [[nodiscard]] bool create_unnamed();
  void create_named();
  void copy_to_named();
  void settle();

  /// Tries up to 1000 temporary names until `claim(name)` succeeds. Returns false and sets errno if none does.
  template <class Claim>
  [[nodiscard]] bool claim_name(Claim&& claim);
  void forget_name(bool unlink) noexcept;
  [[nodiscard]] bool link_as(const char* name) const noexcept;

  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path target_;
  descriptor folder_;
  descriptor file_;
  std::optional<detail::temporary_name> temporary_;
  std::atomic<std::uint64_t>* noted_ = nullptr;  ///< the entry in detail::named_temporaries
  bool replaces_ = false;
  mode_t old_mode_ = 0;
};

/// Removes this process's named temporary files (not on Windows); committing them then fails. The handler of a signal
/// that ends the process may call it: takes no lock and allocates no memory.
void remove_unfinished_files() noexcept;

/// Calls `fill(file_writer&)` and then replaces the file. If anything fails, the callback included, the old file stays
/// whole and no temporary file is left.
template <std::invocable<file_writer&> Fill>
void write_atomically(const std::filesystem::path& path, Fill&& fill) {
  file_writer file(path);
  std::forward<Fill>(fill)(file);
  file.commit();
}

/// Replaces the file's content with these bytes.
void write_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/file.ipp>
#endif
