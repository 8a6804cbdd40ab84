#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/core/error.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>

using gonio::rgb;
using gonio::capture::reference_reflectance;

namespace {

gonio::direction_pair reference_pair(double theta_i, double theta_o) {
  return {gonio::spherical_direction(gonio::radians(theta_i), 0.3),
          gonio::spherical_direction(gonio::radians(theta_o), 2.0)};
}

std::vector<double> reference_angles(std::vector<double> angles) {
  for (double& angle : angles) angle = gonio::radians(angle);
  return angles;
}

rgb uniform_factor(double factor) { return rgb::Constant(factor); }

void refuses_table(const std::vector<double>& theta_i, const std::vector<double>& theta_o,
                   const std::vector<rgb>& factors, const std::string& words) {
  CAPTURE(words);
  CHECK_THROWS_WITH_AS(reference_reflectance(reference_angles(theta_i), reference_angles(theta_o), factors),
                       doctest::Contains(words.c_str()), gonio::error);
}

}  // namespace

TEST_CASE("reference reflectance: a number is the same everywhere") {
  const reference_reflectance constant = 0.8;
  for (const double theta : {0.0, 45.0, 89.9}) CHECK((constant.at(reference_pair(theta, 90.0 - theta)) == 0.8).all());
  CHECK(constant.largest() == 0.8);
  CHECK(reference_reflectance().largest() == 0.99);
}

TEST_CASE("reference reflectance: a table is met at its angles, and linear between them") {
  const reference_reflectance by_light(reference_angles({0, 30, 90}), {},
                                       {uniform_factor(1.0), {0.9, 0.8, 0.7}, uniform_factor(0.5)});
  CHECK((by_light.at(reference_pair(0, 50)) == 1.0).all());
  CHECK(((by_light.at(reference_pair(30, 10)) - rgb(0.9, 0.8, 0.7)).abs() < 1e-12).all());
  CHECK(((by_light.at(reference_pair(50, 80)) - (2.0 * rgb(0.9, 0.8, 0.7) + 0.5) / 3.0).abs() < 1e-12).all());
  CHECK(by_light.largest() == 1.0);

  const reference_reflectance by_both(
      reference_angles({20, 40}), reference_angles({0, 60}),
      {uniform_factor(1.0), uniform_factor(0.8), uniform_factor(0.6), uniform_factor(1.2)});
  CHECK(by_both.at(reference_pair(20, 60)).x() == doctest::Approx(0.8));
  CHECK(by_both.at(reference_pair(40, 0)).x() == doctest::Approx(0.6));
  CHECK(by_both.at(reference_pair(30, 15)).x() ==
        doctest::Approx(0.5 * (0.75 * 1.0 + 0.25 * 0.8 + 0.75 * 0.6 + 0.25 * 1.2)));
  CHECK(by_both.largest() == 1.2);
}

TEST_CASE("reference reflectance: between its angles a table lies between its factors") {
  CHECK(rc::check("bilinear", [] {
    const auto number = [](int from, int to) { return *rc::gen::inRange(from, to) / 100.0; };
    std::vector<rgb> factors;
    for (int i = 0; i < 6; ++i) factors.emplace_back(number(1, 150), number(1, 150), number(1, 150));
    const reference_reflectance table(reference_angles({0, 20, 90}), reference_angles({10, 80}), factors);
    const double theta_i = number(0, 9000), theta_o = number(1000, 8000);
    const std::size_t row = theta_i < 20.0 ? 0 : 2;
    rgb least = factors[row], most = factors[row];
    for (std::size_t i = row; i < row + 4; ++i) {
      least = least.min(factors[i]);
      most = most.max(factors[i]);
    }
    const rgb found = table.at(reference_pair(theta_i, theta_o));
    RC_ASSERT((found > least - 1e-9).all() && (found < most + 1e-9).all());
  }));
}

TEST_CASE("reference reflectance: nothing is extrapolated") {
  const reference_reflectance table(reference_angles({10, 60}), reference_angles({45}),
                                    {uniform_factor(0.9), uniform_factor(0.8)});
  CHECK(table.at(reference_pair(60, 45)).x() == doctest::Approx(0.8));  // up to rounding
  const auto look_up = [&](double theta_i, double theta_o) { return table.at(reference_pair(theta_i, theta_o)); };
  CHECK_THROWS_WITH_AS(look_up(61, 45),
                       "the white reference's table covers theta_i from 10.000000 to 60.000000 degrees, not 61.000000",
                       gonio::error);
  CHECK_THROWS_WITH_AS(look_up(9, 45), doctest::Contains("covers theta_i"), gonio::error);
  CHECK_THROWS_WITH_AS(look_up(30, 44), doctest::Contains("covers theta_o"), gonio::error);
  CHECK_THROWS_AS(table.at({gonio::direction::Constant(std::nan("")), gonio::direction::UnitZ()}), gonio::error);
}

TEST_CASE("reference reflectance: bad input is refused") {
  const double nan = std::nan("");
  for (const double number : {0.0, -0.5, 1.01, nan})
    CHECK_THROWS_WITH_AS(reference_reflectance{number}, doctest::Contains("above 0 and up to 1"), gonio::error);
  refuses_table({}, {}, {}, "has no theta_i");
  refuses_table({0, 30, 30}, {}, {uniform_factor(0.9), uniform_factor(0.9), uniform_factor(0.9)},
                "theta_i of 30.000000 degrees follows 30.000000");
  refuses_table({0, 30}, {60, 20}, std::vector<rgb>(4, uniform_factor(0.9)),
                "theta_o of 20.000000 degrees follows 60.000000");
  refuses_table({-1, 30}, {}, {uniform_factor(0.9), uniform_factor(0.9)},
                "theta_i is -1.000000 degrees, expected 0 to 90");
  refuses_table({0, 91}, {}, {uniform_factor(0.9), uniform_factor(0.9)}, "expected 0 to 90");
  refuses_table({0, nan}, {}, {uniform_factor(0.9), uniform_factor(0.9)}, "expected 0 to 90");
  refuses_table({0, 30}, {0, 30}, {uniform_factor(0.9), uniform_factor(0.9), uniform_factor(0.9)},
                "3 factors, expected 4");
  refuses_table({0, 30}, {}, {uniform_factor(0.9), {0.9, -0.1, 0.9}}, "factor of -0.100000");
  refuses_table({0, 30}, {}, {uniform_factor(0.9), uniform_factor(0.0)}, "factor of 0.000000");
  refuses_table({0, 30}, {}, {uniform_factor(0.9), uniform_factor(nan)}, "factor of nan");
  refuses_table({0, 30}, {}, {uniform_factor(99.0), uniform_factor(98.0)},
                "factor of 99.000000, expected above 0 and up to 1.5");
}
