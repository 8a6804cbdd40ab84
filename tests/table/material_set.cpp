#include <gonio/table/material_set.hpp>

#include <doctest/doctest.h>

#include <limits>

TEST_CASE("a material is found by name and its table is three adjacent columns") {
  const gonio::valid_cells cells(gonio::grid({3, 3, 4}));
  gonio::material_set set{cells, {"clay", "gold"}, gonio::cell_matrix(cells.size(), 6)};
  for (Eigen::Index i = 0; i < set.values.size(); ++i) set.values.data()[i] = static_cast<float>(i);
  CHECK(set.find("gold") == 1);
  CHECK_THROWS_WITH_AS(static_cast<void>(set.find("glod")), doctest::Contains("'glod'"), gonio::error);
  const auto gold = set.table(1);
  CHECK(gold.at(0).isApprox(gonio::rgb(3, 4, 5)));
  CHECK(gold.at(2).isApprox(gonio::rgb(15, 16, 17)));
}

TEST_CASE("some of the materials are copied in the order asked for") {
  const gonio::valid_cells cells(gonio::grid({3, 3, 4}));
  gonio::material_set set{cells, {"clay", "gold", "wood"}, gonio::cell_matrix(cells.size(), 9)};
  for (Eigen::Index i = 0; i < set.values.size(); ++i) set.values.data()[i] = static_cast<float>(i);
  const auto some = set.subset({2, 0});
  CHECK(some.names == std::vector<std::string>{"wood", "clay"});
  CHECK(some.values.leftCols(3) == set.values.rightCols(3));
  CHECK(some.values.rightCols(3) == set.values.leftCols(3));
  CHECK(set.subset({}).values.cols() == 0);
  CHECK_THROWS_WITH_AS(static_cast<void>(set.subset({3})), "there is no material 3 among 3", gonio::error);
}

TEST_CASE("a cell is mapped value by value, and values that are not finite before or after are refused by name") {
  const gonio::valid_cells cells(gonio::grid({3, 3, 4}));
  const Eigen::Index count = cells.size();
  gonio::material_set set{cells, {"clay", "gold"}, gonio::cell_matrix::Ones(count, 6)};
  const auto twice = [](double value) { return 2.0 * value; };
  const auto refused = [&](const auto& map, const char* words) {
    CHECK_THROWS_WITH_AS(gonio::map_cell(set, 2, map), words, gonio::error);
  };
  gonio::map_cell(set, 1, twice);
  CHECK(set.values.row(1).isConstant(2.0f));
  CHECK(set.values.row(0).isConstant(1.0f));
  constexpr float inf = std::numeric_limits<float>::infinity();
  refused([](double) { return double{inf}; }, "material 'clay' is not finite at cell 2");
  set.values.row(2).setOnes();
  set.values(2, 3) = -inf;
  refused([](double) { return 0.0; }, "material 'gold' is not finite at cell 2");
}

TEST_CASE("a set without materials, or whose table does not fit them and the cells, is not complete") {
  const gonio::valid_cells cells(gonio::grid({3, 3, 4}));
  const Eigen::Index count = cells.size();
  CHECK_NOTHROW(gonio::require_complete(gonio::material_set{cells, {"clay"}, gonio::cell_matrix(count, 3)}));
  CHECK_THROWS_AS(gonio::require_complete(gonio::material_set{cells, {}, gonio::cell_matrix(count, 0)}), gonio::error);
  CHECK_THROWS_AS(gonio::require_complete(gonio::material_set{cells, {"clay"}, gonio::cell_matrix(count, 4)}),
                  gonio::error);
  CHECK_THROWS_AS(gonio::require_complete(gonio::material_set{cells, {"clay"}, gonio::cell_matrix(count - 1, 3)}),
                  gonio::error);
}

TEST_CASE("materials of one maker are a family") {
  CHECK(gonio::material_family("cc_iris_purple_gem") == "cc");
  CHECK(gonio::material_family("alum-bronze") == "alum-bronze");
}
