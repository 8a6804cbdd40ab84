#pragma once
/// Files as bytes: reading one whole, and replacing one so that whoever reads it meanwhile sees the old
/// content or the new, never a part. Every failure is a gonio::error that names the path and the system's
/// reason. A process that is killed leaves nothing behind where the system has files without a name
/// (docs/decisions/0017-unfinished-files.md). POSIX.

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

/// What the system says of an error number: "No such file or directory".
[[nodiscard]] std::string system_reason(int code);

/// Throws gonio::error naming the file: the parts of the message, one after the other.
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

/// Opens a file to read, without waiting for one that is no file. Throws gonio::error if it cannot.
[[nodiscard]] descriptor open_to_read(const std::filesystem::path& path);

/// The number of its bytes. Throws gonio::error unless it is a regular file.
[[nodiscard]] std::uint64_t size_of_regular(const descriptor& file, const std::filesystem::path& path);

/// Fills `bytes` from an offset on, as far as the file reaches; returns how many were read. Throws gonio::error if it
/// cannot be read.
[[nodiscard]] std::size_t read_at(const descriptor& file, std::uint64_t offset, std::span<std::byte> bytes,
                                  const std::filesystem::path& path);

/// Writes all bytes where the file is written next. False, and errno, if they cannot be stored.
[[nodiscard]] bool write_all(const descriptor& file, std::span<const std::byte> bytes) noexcept;

/// What a path's symbolic links lead to, be it there or not, so that a link stays a link when written.
[[nodiscard]] std::filesystem::path follow_links(const std::filesystem::path& path);

namespace detail {

/// The name of a temporary file: that of the machine, of the process and a number. Made without memory or locks.
struct temporary_name {
  explicit temporary_name(std::uint32_t number) noexcept;
  [[nodiscard]] const char* c_str() const noexcept { return text.data(); }

  std::uint32_t number;
  std::array<char, 128> text{};
};

/// This process's temporary files that have a name: the descriptor of the folder, plus 1, in the high half, the number
/// in the low one. 0 is a place that is free. More than these at once are written, but not known to
/// remove_unfinished_files.
inline std::array<std::atomic<std::uint64_t>, 64> named_temporaries{};

/// Is this the name of a temporary file of this machine whose process has ended, or of this process?
[[nodiscard]] bool may_be_abandoned(std::string_view name);

/// Removes temporary files that no process holds. What cannot be removed stays.
void remove_abandoned(const std::filesystem::path& folder, const descriptor& opened);

}  // namespace detail

/// The whole content of a regular file.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// What holds the bytes of a file until it is committed.
enum class staging {
  unnamed,  ///< a file without a name, which vanishes with its process; `named` where the system has none
  named     ///< a file `.gonio-HOST-PROCESS-NUMBER.tmp` beside the target, locked while its process lives
};

/// The file that the callback of `write_atomically` fills.
class file_writer {
 public:
  /// Removes what processes that were killed have left in the target's folder, and opens a temporary file there.
  /// Prefer `write_atomically`, which cannot be left halfway.
  explicit file_writer(const std::filesystem::path& path, staging held = staging::unnamed);
  file_writer(const file_writer&) = delete;
  file_writer& operator=(const file_writer&) = delete;
  ~file_writer() { forget_name(true); }

  /// Appends bytes; throws gonio::error naming the target and the reason where they cannot be stored.
  void write(std::span<const std::byte> bytes);

  /// Puts what was written in the target's place. Nothing may be written afterwards.
  void commit();

 private:
  /// rename() would replace a read-only file, or a device like /dev/null, without a word.
  void inspect_target();

  void open_folder();
  [[nodiscard]] bool create_unnamed();
  void create_named();
  void copy_to_named();
  void settle();

  /// Takes one name after the other until `claim(name)` says that it is free. False, and errno, if none is.
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
  std::atomic<std::uint64_t>* noted_ = nullptr;  ///< where remove_unfinished_files finds the temporary file
  bool replaces_ = false;
  mode_t old_mode_ = 0;
};

/// Removes the temporary files that this process has beside its targets. For the handler of a signal that ends the
/// process: it takes no lock and asks for no memory. Whoever writes on afterwards fails.
void remove_unfinished_files() noexcept;

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
#include <gonio/io/bytes/impl/file.ipp>
#endif
