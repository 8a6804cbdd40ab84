#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/basis/discrepancy.hpp>
#include <gonio/metric/log.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using gonio::discrepancy_functions;
using gonio::half_difference;

static_assert(gonio::computed_basis<gonio::discrepancy<gonio::log>>);

namespace {

std::vector<half_difference> some_centres(Eigen::Index count, unsigned seed = 4) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<half_difference> centres;
  for (Eigen::Index i = 0; i < count; ++i)
    centres.push_back({0.9 * uniform(random), 1.2 * uniform(random), std::numbers::pi * uniform(random)});
  return centres;
}

std::vector<double> row_of(const discrepancy_functions& functions, const half_difference& angles) {
  std::vector<double> row(static_cast<Eigen::Index>(functions.size()));
  functions.read(angles, row.data());
  return row;
}

double product_of(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(a); ++i) sum += a[i] * b[i];
  return sum;
}

/// The covariance as basis/discrepancy.hpp documents it.
double covariance(const half_difference& a, const half_difference& b) {
  const auto coordinates = [](const half_difference& at) {
    const double degrees = 180.0 / std::numbers::pi;
    return Eigen::Vector4d(std::sqrt(at.theta_h * degrees / 90.0) / 0.1, at.theta_d * degrees / 90.0 / 0.2,
                           std::sin(at.theta_d) * std::cos(2.0 * at.phi_d) / 2.0 / 0.4,
                           std::sin(at.theta_d) * std::sin(2.0 * at.phi_d) / 2.0 / 0.4);
  };
  return std::exp(-0.5 * (coordinates(a) - coordinates(b)).squaredNorm());
}

}  // namespace

TEST_CASE("many rows at once are those read one by one") {
  const discrepancy_functions functions(some_centres(150), 0.7);
  const auto locations = some_centres(9, 21);
  gonio::row_matrix all(9, 150);
  functions.read(locations, all);
  for (Eigen::Index i = 0; i < 9; ++i) {
    const std::vector<double> row = row_of(functions, locations[i]);
    const Eigen::Map<const Eigen::RowVectorXd> one(row.data(), 150);
    CHECK((all.row(i) - one).cwiseAbs().maxCoeff() < 1e-9 * one.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("weights of unit variance make a discrepancy of the covariance that was asked for") {
  const auto centres = some_centres(30);
  const discrepancy_functions functions(centres, 2.5);
  const half_difference elsewhere{0.31, 0.62, 0.93};
  const auto there = row_of(functions, elsewhere);
  for (const half_difference& a : centres) {
    const auto row = row_of(functions, a);
    CHECK(product_of(row, there) == doctest::Approx(2.5 * covariance(a, elsewhere)).epsilon(1e-5));
    CHECK(std::abs(product_of(row, row) - 2.5) < 1e-5);
    for (const half_difference& b : centres)
      CHECK(std::abs(product_of(row, row_of(functions, b)) - 2.5 * covariance(a, b)) < 1e-5);
  }
  const auto far = row_of(functions, {1.5, 0.0, 0.0});
  CHECK(product_of(far, far) < 0.1);
}

TEST_CASE("phi_d counts modulo 180 degrees, and not at all where theta_d is zero") {
  const auto centres = some_centres(5);
  const discrepancy_functions functions(centres, 1.0);
  const auto same = [&](const half_difference& a, const half_difference& b) {
    const auto x = row_of(functions, a), y = row_of(functions, b);
    for (Eigen::Index i = 0; i < std::ssize(x); ++i) CHECK(x[i] == doctest::Approx(y[i]).epsilon(1e-9));
  };
  same({0.3, 0.5, 0.1}, {0.3, 0.5, 0.1 + std::numbers::pi});
  same({0.3, 0.0, 0.1}, {0.3, 0.0, 1.4});
}

TEST_CASE("theta_d counts more towards grazing if the lengths have a Fresnel weight") {
  // The logarithm of Schlick's reflectance, from f0 = .04 at normal incidence to 1 at grazing.
  CHECK(gonio::fresnel_rise(0.0) == 0.0);
  CHECK(gonio::fresnel_rise(gonio::radians(60.0)) == doctest::Approx(std::log(1.0 + 24.0 / 32.0) / std::log(25.0)));
  CHECK(gonio::fresnel_rise(gonio::radians(90.0)) == doctest::Approx(1.0));
  const gonio::correlation_lengths plain{.theta_d = 0.5}, rising{.theta_d = 0.5, .fresnel_weight = 2.0};
  const half_difference low{0.2, 0.3, 0.0}, high{0.2, 1.3, 0.0}, higher{0.2, 1.4, 0.0};
  const std::vector<half_difference> one{high};
  const auto correlation = [&](const half_difference& other, const gonio::correlation_lengths& lengths) {
    return gonio::discrepancy_covariance(one, other, lengths)[0];
  };
  const double moved = (0.1 / gonio::radians(90.0) + 2.0 * (gonio::fresnel_rise(1.4) - gonio::fresnel_rise(1.3))) / 0.5;
  const double azimuth = (std::sin(1.4) - std::sin(1.3)) / 2.0 / plain.azimuth;
  CHECK(correlation(higher, rising) == doctest::Approx(std::exp(-0.5 * (moved * moved + azimuth * azimuth))));
  CHECK(correlation(higher, rising) < correlation(higher, plain));
  CHECK(correlation(low, rising) < correlation(low, plain));
}

TEST_CASE("a combination at all cells is that of the rows") {
  const gonio::valid_cells& cells = small_cells();
  const gonio::discrepancy functions{cells, gonio::log{}, discrepancy_functions(some_centres(20), 0.7)};
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(20, 3);
  const auto field = functions.combination(weights);
  REQUIRE(field.cols() == cells.size());
  double largest = 0.0;
  for (Eigen::Index cell = 0; cell < std::ssize(cells); ++cell) {
    const Eigen::RowVectorXd row = gonio::row_at(functions, gonio::locate_cell(cells, cell));
    for (Eigen::Index c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(double{field(c, cell)} - row.dot(weights.col(c))));
  }
  CHECK(largest < 1e-5);
  const auto single = functions.combination(weights, gonio::thread_count(1));
  CHECK((field == single).all());
}

TEST_CASE("covariances span the same functions as those of unit variance") {
  const auto centres = some_centres(20);
  const discrepancy_functions whitened(centres, 0.7), covariances = discrepancy_functions::covariances(centres);
  const half_difference elsewhere{0.31, 0.62, 0.93};
  const auto row = row_of(covariances, elsewhere);
  for (Eigen::Index i = 0; i < 20; ++i) CHECK(row[i] == doctest::Approx(covariance(centres[i], elsewhere)));

  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(20, 3), same = whitened.covariance_weights(weights);
  const auto values = [&](const discrepancy_functions& functions, const Eigen::MatrixXd& by) {
    const auto here = row_of(functions, elsewhere);
    return Eigen::RowVector3d(Eigen::Map<const Eigen::RowVectorXd>(here.data(), 20) * by);
  };
  CHECK((values(whitened, weights) - values(covariances, same)).norm() < 1e-9);
  const gonio::valid_cells& cells = small_cells();
  CHECK((whitened.combination(weights, cells) - covariances.combination(same, cells)).abs().maxCoeff() < 1e-5);
  CHECK((covariances.covariance_weights(weights) - weights).norm() == 0.0);
}

TEST_CASE("covariances of one location, of pairs and of all are the same numbers") {
  const auto some = some_centres(7), others = some_centres(5, 21);
  const Eigen::MatrixXd between = gonio::discrepancy_covariance(some, others, {});
  REQUIRE(between.rows() == 7);
  REQUIRE(between.cols() == 5);
  for (Eigen::Index i = 0; i < 7; ++i)
    for (Eigen::Index j = 0; j < 5; ++j) CHECK(between(i, j) == doctest::Approx(covariance(some[i], others[j])));
  CHECK((gonio::discrepancy_covariance(some, others[3]) - between.col(3)).norm() < 1e-12);
  CHECK((gonio::discrepancy_covariance(some) - gonio::discrepancy_covariance(some, some, {})).norm() < 1e-12);
}

TEST_CASE("centres that coincide do no harm") {
  auto centres = some_centres(6);
  centres.push_back(centres[2]);
  const discrepancy_functions functions(centres, 1.0);
  const auto row = row_of(functions, centres[2]);
  CHECK(product_of(row, row) == doctest::Approx(1.0).epsilon(1e-5));
}

TEST_CASE("an impossible discrepancy is refused") {
  const auto refused = [](std::vector<half_difference> centres, double amplitude, gonio::correlation_lengths lengths,
                          std::initializer_list<std::string> words) {
    scratch::check_refused([&] { return discrepancy_functions(centres, amplitude, lengths); }, words);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused({}, 1.0, {}, {"at least one centre"});
  refused({{0.1, nan, 0.2}}, 1.0, {}, {"centre 1", "not finite"});
  refused(some_centres(2), 0.0, {}, {"amplitude", "positive", "0"});
  refused(some_centres(2), nan, {}, {"amplitude", "nan"});
  refused(some_centres(2), 1.0, {0.1, -0.2, 0.4}, {"correlation lengths", "-0.2"});
  refused(some_centres(2), 1.0, {.fresnel_weight = -0.5}, {"Fresnel weight", "at least 0", "-0.5"});
}
