#include "../sanitized.hpp"
#include <gonio/core/huge_pages.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <numeric>
#include <vector>

using floats = std::vector<float, gonio::huge_page_allocator<float>>;

TEST_CASE("huge pages: a vector grows, is copied and moved across the size of a page as any other") {
  floats values;
  for (std::size_t i = 0; i < 3'000'000; ++i) values.push_back(static_cast<float>(i % 1000));
  const floats copy = values;
  const floats moved = std::move(values);
  CHECK(copy == moved);
  CHECK(std::accumulate(copy.begin(), copy.end(), 0.0) == 3000 * 499'500.0);
  std::vector<float, gonio::huge_page_allocator<float>> small(3, 1.0f);
  small = copy;
  CHECK(small.back() == 999.0f);
}

TEST_CASE("huge pages: memory begins at a page of 2 MB if it has more than one, else at a line of the cache") {
  const auto begin_of = [](const floats& values) { return reinterpret_cast<std::uintptr_t>(values.data()); };
  CHECK(begin_of(floats(600'000)) % (std::uintptr_t{1} << 21) == 0);
  CHECK(begin_of(floats(7)) % 64 == 0);
}

TEST_CASE("huge pages: requesting more than the memory throws, as other allocators do" * doctest::skip(sanitized)) {
  gonio::huge_page_allocator<float> allocator;
  CHECK_THROWS_AS(static_cast<void>(allocator.allocate(std::numeric_limits<std::size_t>::max() / 2)), std::bad_alloc);
  CHECK_THROWS_AS(static_cast<void>(allocator.allocate(std::size_t{1} << 59)), std::bad_alloc);
}

TEST_CASE("huge pages: advice leaves memory as it is, of any size and beginning") {
  std::vector<char> memory(5'000'000, 'a');
  for (const std::size_t begin : {0, 1, 4096})
    for (const std::size_t size : {0, 100, 3'000'000, 4'900'000}) gonio::advise_huge_pages(memory.data() + begin, size);
  CHECK(std::count(memory.begin(), memory.end(), 'a') == std::ssize(memory));
}
