#include "../synthetic_materials.hpp"
#include <gonio/basis/material_functions.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

/// A derived class that gives the tests access to the base class.
struct some_functions : gonio::material_functions<gonio::lin> {
  using gonio::material_functions<gonio::lin>::material_functions;
  using gonio::material_functions<gonio::lin>::leave_out;
};
static_assert(gonio::channelwise_basis<some_functions>);

/// Function f of channel c at a cell is 100 cell + 10 c + f.
some_functions numbered_functions(std::vector<std::string> names, Eigen::Index count) {
  const gonio::valid_cells over(gonio::grid({2, 2, 2}));
  gonio::cell_matrix values(over.size(), 3 * count);
  for (Eigen::Index cell = 0; cell < values.rows(); ++cell)
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index f = 0; f < count; ++f)
        values(cell, c * count + f) = static_cast<float>(100 * cell + 10 * c + f);
  return {std::move(names), over, gonio::lin{}, values};
}

}  // namespace

TEST_CASE("a channel's row is its part of the row of all channels, and values() has all of them") {
  const auto functions = numbered_functions({"a", "b"}, 3);
  CHECK(functions.size() == 3);
  CHECK(functions.names() == std::vector<std::string>{"a", "b"});
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = functions.channel(c);
    REQUIRE(channel.size() == 3);
    REQUIRE(channel.cells() == functions.cells());
    for (Eigen::Index cell = 0; cell < functions.cells().size(); ++cell) {
      REQUIRE(channel.row(cell).size() == 3);
      for (std::size_t f = 0; f < 3; ++f) {
        const auto expected = static_cast<float>(100 * cell + 10 * c + f);
        REQUIRE(channel.row(cell)[f] == expected);
        REQUIRE(channel.values()(cell, f) == expected);
      }
    }
  }
}

TEST_CASE("a channel keeps its rows alive") {
  const auto channel = [] { return numbered_functions({"a"}, 1).channel(2); }();
  CHECK(channel.row(1)[0] == 120.0f);
}

TEST_CASE("the products of a channel are the Gram matrix of all functions, those left out included") {
  auto functions = numbered_functions({"a", "b", "c"}, 4);
  functions.leave_out({"b"});
  const auto channel = functions.channel(1);
  const Eigen::MatrixXd values = channel.values().cast<double>();
  const Eigen::MatrixXd products = channel.products();
  REQUIRE(products.rows() == 4);
  // Integers: exact.
  CHECK(products == values.transpose() * values);
  // Computed once and shared by all copies.
  CHECK(&channel.products() == &functions.channel(1).products());
  CHECK(&channel.products() != &functions.channel(0).products());
  functions.leave_out({"a"});
  CHECK(&channel.products() == &functions.channel(1).products());
  CHECK(functions.excluded() == std::vector<std::string>{"a", "b"});
}

TEST_CASE("leaving out: names count, functions without a name stay, and copies are not affected") {
  const auto all = numbered_functions({"a", "b", "c"}, 4);
  CHECK(rc::check("any subset of the names but all of them", [&] {
    std::vector<std::string> out;
    std::vector<Eigen::Index> expected;
    for (std::size_t i = 0; i < 3; ++i) {
      if (*rc::gen::arbitrary<bool>())
        out.push_back(all.names()[i]);
      else
        expected.push_back(i);
    }
    if (!out.empty() && *rc::gen::arbitrary<bool>()) out.push_back(out.front());  // naming it twice is allowed
    auto fewer = all;
    if (expected.empty()) {
      RC_ASSERT_THROWS_AS(fewer.leave_out(out), gonio::error);
      RC_ASSERT(fewer.columns().size() == 4u);  // unchanged
      return;
    }
    fewer.leave_out(out);
    expected.push_back(3);
    RC_ASSERT(std::ranges::equal(fewer.columns(), expected));
    RC_ASSERT(std::ranges::equal(fewer.channel(0).columns(), expected));
    RC_ASSERT(fewer.size() == 4u);
    RC_ASSERT(all.columns().size() == 4u);
    RC_ASSERT(fewer.channel(0).row(0).data() == all.channel(0).row(0).data());
  }));
}

TEST_CASE("functions without any name cannot be the only ones left, and unknown names are refused") {
  auto functions = numbered_functions({"a", "b"}, 3);
  CHECK_THROWS_WITH_AS(functions.leave_out({"a", "x"}), doctest::Contains("'x'"), gonio::error);
  CHECK(functions.columns().size() == 3);
  functions.leave_out({"a"});
  CHECK_THROWS_WITH_AS(functions.leave_out({"b"}), doctest::Contains("left out"), gonio::error);
}

TEST_CASE("sizes that do not match are refused") {
  const gonio::valid_cells over(gonio::grid({2, 2, 2}));
  const Eigen::Index rows = over.size();
  const auto make = [&](std::vector<std::string> names, Eigen::Index height, Eigen::Index columns) {
    return some_functions{std::move(names), over, gonio::lin{}, gonio::cell_matrix::Zero(height, columns)};
  };
  CHECK_NOTHROW(make({"a", "b"}, rows, 6));
  CHECK_NOTHROW(make({"a", "b"}, rows, 9));
  CHECK_THROWS_AS(make({"a", "b"}, rows, 7), gonio::error);      // not a multiple of the channels
  CHECK_THROWS_AS(make({"a", "b"}, rows, 3), gonio::error);      // fewer columns than names
  CHECK_THROWS_AS(make({"a", "b"}, rows - 1, 6), gonio::error);  // a cell is missing
  CHECK_THROWS_AS(make({}, rows, 0), gonio::error);
}
