#include <gonio/table/tensor_view.hpp>

#include <doctest/doctest.h>

#include <cmath>

TEST_CASE("a tensor view writes through, a dense tensor copies and marks cells below the horizon") {
  gonio::brdf_table table(gonio::valid_cells(gonio::grid({6, 5, 8})));
  auto view = gonio::tensor_view(table);
  view(4, 1) = 2.5f;
  CHECK(table.at(4).y() == 2.5);
  CHECK(std::as_const(table).values().data() == gonio::tensor_view(std::as_const(table)).data());

  const auto dense = gonio::dense_tensor(table);
  CHECK(dense.shape()[0] == 6);
  CHECK(dense.shape()[3] == 3);
  const auto index = table.cells().grid().cell(table.cells().linear(4));
  CHECK(dense(index.theta_h, index.theta_d, index.phi_d, 1) == 2.5f);
  CHECK(std::isnan(dense(5, 4, 0, 0)));
}
