#include "../archetypes.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/sampled_functions.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::sampled_functions;

namespace {

const gonio::measured<gonio::log>& seven_materials() {
  static const gonio::measured basis{synthetic_materials(small_cells(), 7), gonio::log{}};
  return basis;
}

/// Returns cells, and locations between them: more than one block of rows.
std::vector<gonio::location> mixed_locations(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<std::size_t> any(0, small_cells().size() - 1);
  std::vector<gonio::location> locations;
  while (locations.size() < count) {
    const std::size_t cell = any(generator);
    auto angles = small_cells().angles(cell);
    angles.theta_h *= 0.9;
    locations.push_back(generator() % 3 == 0 ? gonio::locate(small_cells(), angles)
                                             : gonio::locate_cell(small_cells(), cell));
  }
  return locations;
}

struct random_equations {
  Eigen::ArrayXf weights, values;

  /// A third of the weights are zero.
  random_equations(std::size_t count, unsigned seed) : weights(count), values(count) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> number(0.0f, 2.0f);
    for (float& weight : weights) weight = generator() % 3 == 0 ? 0.0f : number(generator);
    for (float& value : values) value = number(generator);
  }
};

}  // namespace

TEST_CASE("normal equations, right-hand sides and products are those of the gathered rows in double") {
  CHECK(rc::check([] {
    const std::size_t count = *rc::gen::inRange(1, 400);
    const auto seed = static_cast<unsigned>(*rc::gen::inRange(0, 10'000));
    const auto locations = mixed_locations(count, seed);
    const random_equations system(count, seed + 1);
    const sampled_functions functions(seven_materials(), locations);
    RC_ASSERT(functions.size() == count);
    RC_ASSERT(functions.unknowns() == 7);
    const gonio::channel_values all_weights = system.weights.transpose().replicate<3, 1>(),
                                all_values = system.values.transpose().replicate<3, 1>();
    const Eigen::MatrixXd all_rhs = functions.rhs(all_weights, all_values);
    const Eigen::MatrixXd x = Eigen::VectorXd::LinSpaced(21, 0.1, 2.0).reshaped(7, 3);
    const gonio::channel_values all_applied = functions.apply(x);
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Index column = c;
      Eigen::MatrixXd rows(count, 7);
      for (std::size_t i = 0; i < count; ++i) rows.row(i) = gonio::row_at(seven_materials().channel(c), locations[i]);
      const Eigen::VectorXd w = system.weights.matrix().cast<double>(), b = system.values.matrix().cast<double>();
      const Eigen::MatrixXd gram = rows.transpose() * w.asDiagonal() * rows;
      const Eigen::VectorXd rhs = rows.transpose() * w.asDiagonal() * b;
      const auto normal = functions.normal(c, system.weights, system.values);
      // Interpolated rows are rounded to float. All terms are positive.
      const double tolerance = 5e-7;
      RC_ASSERT(((normal.gram() - gram).array().abs() <= tolerance * gram.array()).all());
      RC_ASSERT(((normal.rhs() - rhs).array().abs() <= tolerance * rhs.array()).all());
      RC_ASSERT(std::abs(normal.rhs_squared_norm()[0] - b.dot(w.asDiagonal() * b)) <=
                tolerance * normal.rhs_squared_norm()[0]);
      RC_ASSERT(((all_rhs.col(column) - rhs).array().abs() <= tolerance * rhs.array()).all());
      const Eigen::ArrayXd applied = all_applied.row(column).cast<double>().transpose();
      RC_ASSERT(((applied - (rows * x.col(column)).array()).abs() <= 2e-6 * (rows * x.col(column)).array()).all());
    }
  }));
}

TEST_CASE("fewer samples than functions: no weights explain more than the samples hold") {
  CHECK(rc::check([] {
    const std::size_t count = *rc::gen::inRange(1, 7);
    const auto seed = static_cast<unsigned>(*rc::gen::inRange(0, 10'000));
    const auto locations = mixed_locations(count, seed);
    const random_equations system(count, seed + 1);
    const sampled_functions functions(seven_materials(), locations);
    const auto normal = functions.normal(0, system.weights, system.values);
    Eigen::MatrixXd all(8, 8);
    all << normal.gram(), normal.rhs(), normal.rhs().transpose(), normal.rhs_squared_norm();
    const Eigen::VectorXd scale = all.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    all = scale.asDiagonal() * all * scale.asDiagonal();
    const Eigen::VectorXd eigenvalues = gonio::decompose_symmetric(all, "samples").values;
    RC_ASSERT(eigenvalues[0] >= -1e-14);
    RC_ASSERT(eigenvalues[7 - std::ssize(locations)] <= 1e-14);
    const Eigen::MatrixXd rhs =
        functions.rhs(system.weights.transpose().replicate<3, 1>(), system.values.transpose().replicate<3, 1>());
    RC_ASSERT((rhs.col(0) - normal.rhs()).norm() <= 1e-14 * normal.rhs().norm());
  }));
}

TEST_CASE("rows of weight zero are skipped, whatever is there") {
  const auto locations = mixed_locations(300, 5);
  random_equations system(300, 6);
  const sampled_functions functions(seven_materials(), locations);
  const auto before = functions.normal(0, system.weights, system.values);
  std::vector<gonio::location> kept;
  std::vector<float> weights, values;
  for (Eigen::Index i = 0; i < 300; ++i) {
    if (system.weights[i] == 0.0f)
      system.values[i] = std::nanf("");
    else {
      kept.push_back(locations[i]);
      weights.push_back(system.weights[i]);
      values.push_back(system.values[i]);
    }
  }
  REQUIRE(kept.size() < 250);
  const auto with_nan = functions.normal(0, system.weights, system.values);
  CHECK(with_nan.gram() == before.gram());
  CHECK(with_nan.rhs() == before.rhs());
  CHECK(functions.rhs(system.weights.transpose().replicate<3, 1>(), system.values.transpose().replicate<3, 1>())
            .allFinite());
  const auto count = std::ssize(weights);
  const auto without = sampled_functions(seven_materials(), kept)
                           .normal(0, Eigen::Map<const Eigen::ArrayXf>(weights.data(), count),
                                   Eigen::Map<const Eigen::ArrayXf>(values.data(), count));
  // Blocks of 128 rows start at other rows.
  CHECK(without.gram().isApprox(before.gram(), 1e-6));
  CHECK(without.rhs().isApprox(before.rhs(), 1e-6));
  // All weights zero.
  const Eigen::ArrayXf none = Eigen::ArrayXf::Zero(300);
  CHECK(functions.normal(1, none, none).gram().isZero(0.0));
}

TEST_CASE("rows of negligible weight count as rows of weight zero, unless their values are large") {
  const auto locations = mixed_locations(2, 5);
  const sampled_functions functions(seven_materials(), locations);
  const Eigen::Array2f weights(2.0f, 1e-6f);
  const auto both = functions.normal(1, weights, Eigen::Array2f(1.0f, 1.0f));
  const auto first = functions.normal(1, Eigen::Array2f(2.0f, 0.0f), Eigen::Array2f(1.0f, 1.0f));
  CHECK(both.gram() == first.gram());
  CHECK(both.rhs() == first.rhs());
  const auto large = functions.normal(1, weights, Eigen::Array2f(1.0f, 1e3f));
  CHECK(large.rhs()(0, 0) > first.rhs()(0, 0));
}

TEST_CASE("a row at a cell is the basis' own, and between cells the interpolated one") {
  auto angles = small_cells().angles(100);
  angles.theta_d += 0.03;
  const std::vector<gonio::location> locations{gonio::locate_cell(small_cells(), 100),
                                               gonio::locate(small_cells(), angles)};
  REQUIRE(locations[1].count > 1);
  const sampled_functions functions(seven_materials(), locations);
  for (Eigen::Index f = 0; f < 7; ++f) {
    const auto values = functions.apply(Eigen::VectorXd::Unit(7, f).replicate<1, 3>());
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto channel = seven_materials().channel(c);
      CHECK(values(c, 0) == channel.row(100)[f]);
      CHECK(values(c, 1) == static_cast<float>(gonio::row_at(channel, locations[1])[f]));
      CHECK(values(c, 0) != values(c, 1));
    }
  }
}

TEST_CASE("functions left out are in the equations, but not among the columns") {
  const auto fewer = seven_materials().without({"material-2"});
  const auto locations = mixed_locations(50, 3);
  const random_equations system(50, 4);
  const sampled_functions functions(fewer, locations), all(seven_materials(), locations);
  CHECK(functions.columns() == std::vector<Eigen::Index>{0, 1, 3, 4, 5, 6});
  CHECK(functions.unknowns() == 7);
  CHECK(functions.normal(2, system.weights, system.values).gram() ==
        all.normal(2, system.weights, system.values).gram());
}

TEST_CASE("sampled functions outlive their basis, and are the same for any number of threads") {
  const auto locations = mixed_locations(5000, 11);
  const random_equations system(5000, 12);
  const auto make = [&](unsigned threads) {
    const gonio::measured basis{synthetic_materials(small_cells(), 7), gonio::log{}};
    return sampled_functions(basis, locations, {threads});
  };
  const auto one = make(1), three = make(3);
  for (std::size_t c = 0; c < 3; ++c)
    CHECK(one.normal(c, system.weights, system.values).gram() == three.normal(c, system.weights, system.values).gram());
  const Eigen::MatrixXd x = Eigen::MatrixXd::Ones(7, 3);
  CHECK((one.apply(x) == three.apply(x)).all());
  const gonio::channel_values weights = system.weights.transpose().replicate<3, 1>(),
                              values = system.values.transpose().replicate<3, 1>();
  CHECK(one.rhs(weights, values) == three.rhs(weights, values));
}

TEST_CASE("copies do not read the rows of their originals") {
  const auto locations = mixed_locations(50, 8);
  const Eigen::MatrixXd x = Eigen::MatrixXd::Ones(7, 3);
  auto original = std::make_unique<sampled_functions<gonio::measured<gonio::log>>>(seven_materials(), locations);
  const gonio::channel_values before = original->apply(x);
  const auto copy = *original;
  original.reset();
  const auto overwritten = std::make_unique<sampled_functions<gonio::measured<gonio::log>>>(
      seven_materials(), std::vector<gonio::location>(50, locations[0]));
  CHECK((copy.apply(x) == before).all());
}

TEST_CASE("archetype: one function for all channels") {
  const archetype::constant_basis constant{small_cells()};
  const sampled_functions functions(constant, mixed_locations(10, 1));
  const Eigen::ArrayXf weights = Eigen::ArrayXf::Constant(10, 0.5f), values = Eigen::ArrayXf::LinSpaced(10, 0, 9);
  CHECK(functions.normal(2, weights, values).gram()(0, 0) == doctest::Approx(5.0));
  const Eigen::MatrixXd rhs =
      functions.rhs(weights.transpose().replicate<3, 1>(), values.transpose().replicate<3, 1>());
  CHECK(rhs.isApprox(Eigen::RowVector3d::Constant(22.5), 1e-6));
  CHECK((functions.apply(Eigen::RowVector3d::Constant(3.0)) == 3.0f).all());
}

TEST_CASE("no locations: nothing is known") {
  const sampled_functions functions(seven_materials(), {});
  const Eigen::ArrayXf none;
  CHECK(functions.size() == 0);
  CHECK(functions.normal(0, none, none).gram().isZero(0.0));
  CHECK(functions.rhs(gonio::channel_values(3, 0), gonio::channel_values(3, 0)).isZero(0.0));
  CHECK(functions.apply(Eigen::MatrixXd::Ones(7, 3)).size() == 0);
}
