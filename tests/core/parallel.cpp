#include <gonio/core/parallel.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

TEST_CASE("every index is visited once, whatever the block size and the number of threads") {
  for (const unsigned threads : {1u, 2u, 7u})
    for (const std::size_t block_size : {1u, 3u, 100u, 1000u}) {
      std::vector<std::atomic<int>> visits(257);
      gonio::for_each_block(visits.size(), block_size,
                            [&](gonio::block range) {
                              CHECK(range.size() <= block_size);
                              for (Eigen::Index i = range.begin; i < range.end; ++i) ++visits[i];
                            },
                            {threads});
      for (const auto& count : visits) CHECK(count == 1);
    }
}

TEST_CASE("one index at a time: each once, and the first one's exception") {
  for (const unsigned threads : {1u, 3u}) {
    std::vector<std::atomic<int>> visits(257);
    gonio::for_each_index(visits.size(), 10, [&](std::size_t i) { ++visits[i]; }, {threads});
    for (const auto& count : visits) CHECK(count == 1);
    const auto fail = [](std::size_t i) {
      if (i == 3) throw std::runtime_error("three");
    };
    CHECK_THROWS_WITH(gonio::for_each_index(5, 1, fail, {threads}), "three");
  }
}

TEST_CASE("an empty range calls nothing") {
  gonio::for_each_block(0, 8, [](gonio::block) { FAIL("called for an empty range"); });
  CHECK(gonio::sum_over_blocks(0, 8, 1.5, [](double&, gonio::block) {}) == 1.5);
}

TEST_CASE("sums have the same bytes for any number of threads") {
  const auto sum = [](unsigned threads) {
    return gonio::sum_over_blocks(100'003, 64, 0.0,
                                  [](double& partial, gonio::block range) {
                                    for (Eigen::Index i = range.begin; i < range.end; ++i)
                                      partial += std::sin(static_cast<double>(i)) * 1e8;
                                  },
                                  {threads});
  };
  const double one = sum(1);
  for (const unsigned threads : {2u, 3u, 16u}) CHECK(sum(threads) == one);
}

TEST_CASE("the first failing block's exception arrives") {
  for (const unsigned threads : {1u, 4u})
    CHECK_THROWS_WITH_AS(gonio::for_each_block(100, 1,
                                               [](gonio::block range) {
                                                 if (range.begin >= 1) throw std::runtime_error("block 1 failed");
                                               },
                                               {threads}),
                         "block 1 failed", std::runtime_error);
}
