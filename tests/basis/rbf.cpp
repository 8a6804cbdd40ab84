#include "../synthetic_materials.hpp"
#include <gonio/basis/rbf.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using gonio::rbf;

static_assert(gonio::computed_basis<rbf<gonio::log>> && !gonio::tabulated_basis<rbf<gonio::log>>);
static_assert(gonio::estimator<gonio::decomposition<rbf<gonio::log>, gonio::tikhonov>>);
static_assert(!gonio::non_negative_weights_need_functions_of_definite_sign<rbf<gonio::log>, gonio::nnls>);
static_assert(!gonio::radial_kernel<int>);

namespace {

gonio::half_difference in_degrees(double theta_h, double theta_d, double phi_d) {
  return {gonio::radians(theta_h), gonio::radians(theta_d), gonio::radians(phi_d)};
}

/// Centres and samples of the golden values below.
const std::vector<gonio::half_difference> five_centres{in_degrees(10, 20, 30), in_degrees(2, 50, 120),
                                                       in_degrees(40, 10, 80), in_degrees(25, 35, 150),
                                                       in_degrees(60, 5, 10)};

gonio::sample_set fifteen_samples() {
  gonio::sample_set samples;
  for (int i = 0; i < 15; ++i)
    samples.push_back({in_degrees(3 * i + 1, (7 * i) % 45 + 1, (37 * i) % 180),
                       gonio::rgb::Constant(1.0 + 2.0 * std::exp(-i / 3.0) + 0.1 * (i % 3))});
  return samples;
}

/// The cube of the distance: a smoother kernel with a larger condition number.
struct cubic_kernel {
  static void apply(gonio::kernel_row squares) noexcept { squares *= squares.sqrt(); }
};

/// exp(-(r / width)^2): its support is local in practice.
class gaussian_kernel {
 public:
  explicit gaussian_kernel(double width) : width_(width) {}

  void apply(gonio::kernel_row squares) const noexcept { squares = (squares / (-width_ * width_)).exp(); }

 private:
  double width_;
};

static_assert(gonio::radial_kernel<cubic_kernel> && gonio::radial_kernel<gaussian_kernel>);
static_assert(gonio::colour_basis<rbf<gonio::log_relative, cubic_kernel>>);

/// The kernel as documented in `radial_kernel`.
struct thin_plate_kernel {
  void apply(gonio::kernel_row squares) const { squares *= 0.5 * squares.max(1e-300).log(); }
};
static_assert(gonio::radial_kernel<thin_plate_kernel>);

/// Returns the fit's value at a location above the horizon.
template <class Fit>
gonio::rgb value_at(const Fit& fit, const gonio::half_difference& angles) {
  const auto [wi, wo] = to_directions(angles);
  return fit(wi, wo);
}

/// A smooth table with a highlight, over the small cells.
const gonio::brdf_table& smooth_table() {
  static const auto table = synthetic_materials(small_cells(), 3).table(1);
  return table;
}

}  // namespace

TEST_CASE("radial coordinates: the root of theta_h, and a disc of theta_d and 2 phi_d") {
  CHECK(gonio::radial_coordinates(in_degrees(22.5, 45, 45)).isApprox(Eigen::Vector3d(0.5, 0, 0.5), 1e-14));
  CHECK(gonio::radial_coordinates(in_degrees(90, 90, 90)).isApprox(Eigen::Vector3d(1, -1, 0), 1e-14));
  const auto here = gonio::radial_coordinates(in_degrees(10, 30, 0));
  CHECK(here.isApprox(gonio::radial_coordinates(in_degrees(10, 30, 180)), 1e-14));
  CHECK((here - gonio::radial_coordinates(in_degrees(10, 30, 179.999))).norm() < 1e-4);
  CHECK(gonio::radial_coordinates(in_degrees(10, 0, 12)) == gonio::radial_coordinates(in_degrees(10, 0, 77)));
}

TEST_CASE("a row is the kernel of the distance to each centre, 1 and the coordinates") {
  const rbf functions{small_cells(), gonio::lin{}, five_centres};
  REQUIRE(functions.size() == 9);
  const auto at = gonio::locate(functions.cells(), in_degrees(22.5, 45, 45));
  const Eigen::RowVectorXd row = gonio::row_at(functions, at);
  const std::array expected{0.3670291597370504,
                            1.078386861638979,
                            0.5021167380628004,
                            0.8595078394125117,
                            0.5781482391380076,
                            1.0,
                            0.5,
                            0.0,
                            0.5};
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(row[i] == doctest::Approx(expected[i]).epsilon(1e-14));
  CHECK(functions.offset(3) == 0.0);
  CHECK(functions.metric().map(2.0) == 2.0);
}

TEST_CASE("kernels are their documented functions of the distance") {
  Eigen::Array<double, 1, Eigen::Dynamic> squares(4), linear, cubic, gaussian, thin;
  squares << 0.0, 0.25, 1.0, 4.0;
  linear = cubic = gaussian = thin = squares;
  gonio::linear_kernel::apply(linear);
  cubic_kernel::apply(cubic);
  gaussian_kernel{0.5}.apply(gaussian);
  thin_plate_kernel{}.apply(thin);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double r = std::sqrt(squares[i]);
    CHECK(linear[i] == doctest::Approx(r));
    CHECK(cubic[i] == doctest::Approx(r * r * r));
    CHECK(gaussian[i] == doctest::Approx(std::exp(-4.0 * r * r)));
    CHECK(thin[i] == doctest::Approx(r > 0.0 ? r * r * std::log(r) : 0.0));
  }
}

// From exact arithmetic in a script that shares no code with the library.
TEST_CASE("golden: the fit of fifteen samples by five centres") {
  const auto check = [](const auto& functions, double near_highlight, double far_from_it) {
    const auto fit = gonio::decomposition{functions, gonio::tikhonov{1e-13}}.fit(fifteen_samples());
    CHECK(value_at(fit, in_degrees(5, 30, 45)).x() == doctest::Approx(near_highlight).epsilon(1e-7));
    CHECK(value_at(fit, in_degrees(30, 30, 135)).z() == doctest::Approx(far_from_it).epsilon(1e-7));
  };
  check(rbf{small_cells(), gonio::log{}, five_centres}, 2.3851735377459895, 1.0773435275343592);
  check(rbf{small_cells(), gonio::log{}, five_centres, cubic_kernel{}}, 2.3796288130559278, 1.0833480874645973);
  check(rbf{small_cells(), gonio::log{}, five_centres, gaussian_kernel{0.5}}, 2.339723311740751, 1.0825730112110894);
}

TEST_CASE("affine functions of the coordinates come back exactly, wherever they are asked for") {
  const rbf functions{small_cells(), gonio::lin{}, gonio::farthest_point_centres(small_cells(), 40)};
  const gonio::decomposition estimator{functions, gonio::tikhonov{1e-9}};
  CHECK(rc::check([&] {
    const auto any = [] { return 0.01 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-100, 101)); };
    const Eigen::Vector3d slope(any(), any(), any());
    const auto truth = [&](const gonio::half_difference& angles) {
      return 4.0 + slope.dot(gonio::radial_coordinates(angles));
    };
    gonio::brdf_table table(small_cells());
    for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
      table.set(cell, gonio::rgb::Constant(truth(small_cells().angles(cell))));
    const auto fit = estimator.fit(table);
    for (const auto& angles : {in_degrees(0.5, 3, 12), in_degrees(33, 41, 179), in_degrees(60, 22, 90)})
      RC_ASSERT(std::abs(value_at(fit, angles).y() - truth(angles)) < 1e-6);
  }));
}

TEST_CASE("measured at its centres alone, a fit interpolates the values there") {
  const auto centres = gonio::farthest_point_centres(small_cells(), 60, 3);
  gonio::sample_set samples;
  for (Eigen::Index i = 0; i < std::ssize(centres); ++i)
    samples.push_back({centres[i], gonio::rgb(1.0, 0.4, 0.5) + 0.3 * std::sin(17.0 * static_cast<double>(i))});
  const auto fit = gonio::decomposition{rbf{small_cells(), gonio::log{}, centres}, gonio::tikhonov{1e-10}}.fit(samples);
  for (const gonio::sample& s : samples) CHECK((value_at(fit, s.angles()) - s.value).abs().maxCoeff() < 1e-6);
  CHECK(fit.report()->kkt_residual.maxCoeff() < 1e-9);
}

TEST_CASE("each farthest-point centre is farther from those before it than any cell is from all of them") {
  const auto centres = gonio::farthest_point_centres(small_cells(), 50, 9);
  REQUIRE(centres.size() == 50);
  const auto distance_to_first = [&](std::size_t count, const gonio::half_difference& angles) {
    double least = 100.0;
    for (std::size_t i = 0; i < count; ++i)
      least = std::min(least, (gonio::radial_coordinates(centres[i]) - gonio::radial_coordinates(angles)).norm());
    return least;
  };
  double separation = 100.0, covering = 0.0;
  for (Eigen::Index i = 1; i < std::ssize(centres); ++i)
    separation = std::min(separation, distance_to_first(i, centres[i]));
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    covering = std::max(covering, distance_to_first(centres.size(), small_cells().angles(cell)));
  CHECK(separation > 0.05);
  CHECK(separation >= covering - 1e-12);
}

TEST_CASE("centres come from the seed, and 758 by default") {
  const auto first_centre = [](std::uint64_t seed) {
    return gonio::radial_coordinates(gonio::farthest_point_centres(small_cells(), 1, seed).front());
  };
  CHECK(first_centre(4) == first_centre(4));
  const std::array others{first_centre(1), first_centre(2), first_centre(3)};
  CHECK(std::ranges::any_of(others, [&](const Eigen::Vector3d& other) { return other != first_centre(4); }));
  const gonio::valid_cells enough(gonio::grid({20, 15, 20}));
  CHECK(rbf{enough, gonio::log{}}.size() == 762);
  CHECK(rbf<gonio::log>{enough}.cells() == enough);
}

TEST_CASE("a table is approximated, expanded at any cells as evaluated, by any number of threads") {
  const rbf functions{small_cells(), gonio::log{}, gonio::farthest_point_centres(small_cells(), 120)};
  const auto fit = gonio::decomposition{functions, gonio::tikhonov{1e-6}, {1}}.fit(smooth_table());
  const auto threaded = gonio::decomposition{functions, gonio::tikhonov{1e-6}, {3}}.fit(smooth_table());
  CHECK(fit.weights() == threaded.weights());
  CHECK(fit.report()->kkt_residual.maxCoeff() < 1e-9);
  for (const auto& over : {small_cells(), gonio::valid_cells(gonio::grid({7, 5, 12}))}) {
    const auto table = fit.tabulate(over, {1});
    CHECK(std::ranges::equal(table.values(), fit.tabulate(over, {3}).values()));
    CHECK(std::ranges::equal(table.values(), fit.tabulate_cells(over).values()));
    for (Eigen::Index cell = 0; cell < over.size(); ++cell) {
      const gonio::rgb direct = value_at(fit, over.angles(cell));
      REQUIRE((table.at(cell) - direct).abs().maxCoeff() <= 1e-6 * (1.0 + direct.maxCoeff()));
      REQUIRE((direct >= 0.0).all());
    }
  }
  const auto table = fit.tabulate(small_cells());
  double error = 0.0;
  for (std::size_t i = 0; i < table.values().size(); ++i)
    error = std::max(error,
                     std::abs(std::log1p(double{table.values()[i]}) - std::log1p(double{smooth_table().values()[i]})));
  CHECK(error < 0.5);
  CHECK(fit.mapped_field()(1, 5) == doctest::Approx(fit.mapped(5).y()));
  CHECK((fit({0, 0, 1}, {1, 0, 0}) == 0.0).all());
}

TEST_CASE("a metric with a reference: weights of zero give the reference, tabulated or evaluated") {
  const auto metric = gonio::log_relative::to_median_of(synthetic_materials(small_cells(), 3));
  const rbf functions{small_cells(), metric, five_centres};
  const auto fit = gonio::decomposition{functions, gonio::tikhonov{1e12}}.fit(smooth_table());
  const auto table = fit.tabulate(small_cells());
  for (const Eigen::Index cell : {Eigen::Index{7}, small_cells().size() / 2}) {
    CHECK(table.at(cell).x() == doctest::Approx(metric.reference()[cell]).epsilon(1e-4));
    CHECK(value_at(fit, small_cells().angles(cell)).x() == doctest::Approx(metric.reference()[cell]).epsilon(1e-4));
  }
}

TEST_CASE("radial basis functions that cannot be are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS((rbf{small_cells(), gonio::lin{}, std::vector<gonio::half_difference>{}}),
                       doctest::Contains("at least one centre"), gonio::error);
  auto centres = five_centres;
  centres[3].phi_d = nan;
  CHECK_THROWS_WITH_AS((rbf{small_cells(), gonio::lin{}, centres}), doctest::Contains("centre 4"), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::farthest_point_centres(small_cells(), 100'000), doctest::Contains("100000"),
                       gonio::error);
  // At theta_d = 0 all phi_d are the same location.
  const gonio::valid_cells corners(gonio::grid({4, 1, 30}, gonio::cell_anchor::lower_corner));
  CHECK(gonio::farthest_point_centres(corners, 4).size() == 4);
  CHECK_THROWS_WITH_AS(gonio::farthest_point_centres(corners, 5), doctest::Contains("among 4 locations"), gonio::error);
}

TEST_CASE("samples that cannot be used, and more functions than a fit can evaluate, are refused") {
  const rbf functions{small_cells(), gonio::log{}, five_centres};
  CHECK_THROWS_AS((gonio::decomposition{functions, gonio::tikhonov{1e-6}}.fit(gonio::sample_set{})), gonio::error);
  const std::vector<gonio::half_difference> many(5000, five_centres[0]);
  gonio::solution found;
  found.weights = Eigen::MatrixXd::Zero(5004, 3);
  CHECK_THROWS_WITH_AS((gonio::fitted_brdf{rbf{small_cells(), gonio::log{}, many}, found}), doctest::Contains("5004"),
                       gonio::error);
}
