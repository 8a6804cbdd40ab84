#include <gonio/core/error.hpp>
#include <gonio/solve/row_groups.hpp>

#include <doctest/doctest.h>

using gonio::row_groups;

TEST_CASE("groups of rows cover them all, in multiples of 128") {
  for (const Eigen::Index rows : {0, 1, 128, 129, 5000, 1'100'000}) {
    Eigen::Index end = 0;
    for (Eigen::Index group = 0; group < row_groups; ++group) {
      const gonio::block own = gonio::rows_of_groups(rows, {group, group + 1});
      CHECK(own.begin == end);
      CHECK(own.end >= own.begin);
      if (own.end < rows) CHECK(own.end % 128 == 0);
      end = own.end;
    }
    CHECK(end == rows);
  }
}

TEST_CASE("passes over groups of rows: exact, and the same bytes however the groups are shared") {
  const gonio::row_matrix a = gonio::row_matrix::Random(5000, 23);
  const Eigen::MatrixXd u = Eigen::MatrixXd::Random(23, 4), exact = a.transpose() * a;
  const gonio::row_source rows = gonio::rows_of(a);
  const Eigen::MatrixXd gram = gonio::gram(rows, gonio::all_row_groups, {1});
  const Eigen::MatrixXd times = gonio::gram_times(rows, u, gonio::all_row_groups, {1});
  CHECK(gram.isApprox(exact, 1e-14));
  CHECK(times.isApprox(exact * u, 1e-13));
  CHECK(gram == gonio::gram(rows, gonio::all_row_groups, {3}));
  for (const Eigen::Index ranks : {2, 4, 16, 64}) {
    std::vector<Eigen::MatrixXd> grams, products;
    for (Eigen::Index rank = 0; rank < ranks; ++rank) {
      const gonio::block own{rank * row_groups / ranks, (rank + 1) * row_groups / ranks};
      grams.push_back(gonio::gram(rows, own, {2}));
      products.push_back(gonio::gram_times(rows, u, own, {2}));
    }
    CHECK(gonio::sum_of_subtrees(grams) == gram);
    CHECK(gonio::sum_of_subtrees(products) == times);
  }
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(5000, 4), meanwhile = along;
  const auto to = [](Eigen::MatrixXd& all) {
    return [&all](gonio::block range, const Eigen::MatrixXd& product) {
      all.middleRows(range.begin, range.size()) = product;
    };
  };
  gonio::for_each_product(rows, u, gonio::all_row_groups, {3}, to(along));
  static_cast<void>(gonio::gram_times(rows, u, gonio::all_row_groups, {3}, to(meanwhile)));
  CHECK(along.isApprox(a * u, 1e-13));
  CHECK(along == meanwhile);
}

TEST_CASE("groups that are no subtree are refused") {
  const gonio::row_source rows = gonio::rows_of(gonio::row_matrix::Random(10, 2));
  for (const gonio::block groups : {gonio::block{0, 3}, {1, 3}, {0, 0}, {row_groups, 2 * row_groups}, {-2, 0}})
    CHECK_THROWS_AS(gonio::gram(rows, groups), gonio::error);
  CHECK_THROWS_AS(gonio::sum_of_subtrees({}), gonio::error);
  CHECK_THROWS_AS(gonio::sum_of_subtrees(std::vector<Eigen::MatrixXd>(3)), gonio::error);
}
