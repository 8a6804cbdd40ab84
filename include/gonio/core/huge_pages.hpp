#pragma once
/// Memory for large tables that are read at random. A processor caches the addresses of some thousand pages. A table of
/// 18 MB has 4,400 pages of 4 kB, or nine of 2 MB.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace gonio {

inline constexpr std::size_t huge_page = std::size_t{1} << 21;

/// Requests pages of 2 MB for memory that has not been written to. On systems without such pages, or other than Linux,
/// the memory is only slower.
inline void advise_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(__linux__)
  void* begin = memory;
  std::size_t space = bytes;
  if (std::align(huge_page, huge_page, begin, space) != nullptr)
    static_cast<void>(::madvise(begin, space / huge_page * huge_page, MADV_HUGEPAGE));
#endif
}

/// An allocator that requests pages of 2 MB for memory of more than 2 MB. On systems without such pages, or other than
/// Linux, the memory is only slower. Allocates up to 2 MB more than requested.
template <class T>
struct huge_page_allocator {
  using value_type = T;

  huge_page_allocator() = default;
  template <class Other>
  huge_page_allocator(const huge_page_allocator<Other>& /*unused*/) noexcept {}  // NOLINT: implicit by the standard

  [[nodiscard]] T* allocate(std::size_t count) {
    // Let `operator new` refuse impossible sizes: this code throws nothing, and compiles without exceptions.
    count = std::min(count, (std::numeric_limits<std::ptrdiff_t>::max() - page) / sizeof(T));
    if (!is_large(count)) return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{64}));
    const std::size_t bytes = (count * sizeof(T) + page - 1) / page * page;
    void* memory = ::operator new (bytes, std::align_val_t{page});
    advise_huge_pages(memory, bytes);
    return static_cast<T*>(memory);
  }

  void deallocate(T* memory, std::size_t count) noexcept {
    ::operator delete (memory, std::align_val_t{is_large(count) ? page : 64});
  }

  friend bool operator==(const huge_page_allocator& /*unused*/, const huge_page_allocator& /*unused*/) noexcept {
    return true;
  }

 private:
  static constexpr std::size_t page = huge_page;

  [[nodiscard]] static bool is_large(std::size_t count) noexcept { return count > page / sizeof(T); }
};

}  // namespace gonio
