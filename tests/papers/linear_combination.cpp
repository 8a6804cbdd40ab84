#include "papers/noell2014/linear_combination.hpp"

#include "../synthetic_materials.hpp"
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>

#include <doctest/doctest.h>

#include <array>

TEST_CASE("a material that is a combination of others comes back, another not") {
  const gonio::valid_cells cells(gonio::grid({24, 15, 18}));
  auto materials = synthetic_materials(cells, 8);
  // Material 5 in the logarithm: the mean of materials 0 and 3.
  for (Eigen::Index c = 0; c < 3; ++c)
    materials.values.col(15 + c) =
        ((materials.values.col(c).array().log1p() + materials.values.col(9 + c).array().log1p()) * 0.5f).expm1();
  const auto metric = gonio::log_relative::to_median_of(materials);
  const gonio::appearance_metric judge(cells, 12);
  const papers::leave_one_out_decomposition others{gonio::measured{materials, gonio::log{}}, gonio::nnls{}};
  const std::array<std::string, 2> names{"material-5", "material-1"};
  const auto results = papers::combine_others(others, names, materials, metric, judge);
  REQUIRE(results.size() == 2);
  CHECK(results[0].name == "material-5");
  CHECK(results[0].errors.mapped_rms.maxCoeff() < 1e-3);
  CHECK(results[0].errors.delta_e_env < 0.01);
  CHECK(results[1].errors.mapped_rms.maxCoeff() > 1e-2);
}
