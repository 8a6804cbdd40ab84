#include <gonio/core/k_d_tree.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

TEST_CASE("the nearest points are those that a search through all finds") {
  CHECK(rc::check([] {
    std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
    const auto any_number = [](int least, int below) {
      return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(least, below));
    };
    const Eigen::Index count = any_number(1, 200), wanted = any_number(1, 21);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    using points = gonio::k_d_tree<4>::points;
    const points all = points::NullaryExpr(4, count, [&] { return uniform(generator); });
    const gonio::k_d_tree<4> tree(all);
    const Eigen::Vector4d query(uniform(generator), uniform(generator), uniform(generator), uniform(generator));

    std::vector<std::pair<double, std::uint32_t>> sorted;
    for (Eigen::Index i = 0; i < count; ++i)
      sorted.emplace_back((all.col(i) - query).squaredNorm(), static_cast<std::uint32_t>(i));
    std::ranges::sort(sorted);

    std::array<std::uint32_t, 20> numbers{};
    std::array<double, 20> squared{};
    const Eigen::Index found = tree.nearest(query.data(), wanted, numbers.data(), squared.data());
    RC_ASSERT(found == std::min(count, wanted));
    for (Eigen::Index i = 0; i < found; ++i) {
      RC_ASSERT(numbers[i] == sorted[i].second);
      RC_ASSERT(std::abs(squared[i] - sorted[i].first) < 1e-12);
    }

    constexpr double radius = 0.8;
    std::vector<Eigen::Index> expected, within = tree.within(radius, query.data());
    for (const auto& [square, number] : sorted)
      if (square < radius * radius) expected.push_back(number);
    std::ranges::sort(expected);
    std::ranges::sort(within);
    RC_ASSERT(within == expected);
  }));
}

TEST_CASE("points at one location are all found") {
  const gonio::k_d_tree<3>::points same = Eigen::Vector3d(1.0, 2.0, 3.0).replicate(1, 40);
  const gonio::k_d_tree<3> tree(same);
  const Eigen::Vector3d query(1.0, 2.0, 3.0);
  CHECK(tree.within(0.1, query.data()).size() == 40);
  std::array<std::uint32_t, 8> numbers{};
  std::array<double, 8> squared{};
  CHECK(tree.nearest(query.data(), 8, numbers.data(), squared.data()) == 8);
  CHECK(squared.back() == 0.0);
}
