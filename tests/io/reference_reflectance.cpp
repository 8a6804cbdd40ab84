#include "scratch.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/io/measurements/reference_reflectance.hpp>

#include <doctest/doctest.h>

#include <cmath>

using gonio::io::read_reference_reflectance;

namespace {

gonio::direction_pair pair_at(double theta_i, double theta_o) {
  return {gonio::spherical_direction(gonio::radians(theta_i), 0.0),
          gonio::spherical_direction(gonio::radians(theta_o), 1.0)};
}

gonio::capture::reference_reflectance read(const scratch::folder& here, const std::string& text) {
  scratch::put(here / "white.csv", text);
  return read_reference_reflectance(here / "white.csv");
}

}  // namespace

TEST_CASE("reference reflectance: columns in any order, for one or both angles, for one or three channels") {
  const scratch::folder here;
  const auto by_light = read(here, "# ours\n factor , theta_i\n0.99,0\n\n0.9,80\n");
  CHECK(by_light.at(pair_at(40, 70)).y() == doctest::Approx(0.945));
  const auto by_both = read(here,
                            "theta_o,theta_i,factor_b,factor_r,factor_g\n"
                            "0,10,0.3,0.1,0.2\n60,10,0.6,0.4,0.5\n"
                            "0,50,0.9,0.7,0.8\n60,50,1.2,1.0,1.1\n");
  CHECK(((by_both.at(pair_at(10, 60)) - gonio::rgb(0.4, 0.5, 0.6)).abs() < 1e-9).all());
  CHECK(((by_both.at(pair_at(50, 0)) - gonio::rgb(0.7, 0.8, 0.9)).abs() < 1e-9).all());
}

TEST_CASE("reference reflectance: any dialect, and angles and factors with their units") {
  const scratch::folder here;
  const auto german = read(here, "\xEF\xBB\xBF\"# Wei\xC3\x9F\";;\nTheta_I [rad];factor (%);\n0;99;\n;;\n1,5;90,5;\n");
  CHECK(german.at(pair_at(gonio::degrees(0.75), 70)).y() == doctest::Approx(0.9475));
  const auto blanks = read(here, "theta_i theta_o_deg factor\n0 0 0.9\n0 60 0.8\n");
  CHECK(blanks.at(pair_at(0, 30)).y() == doctest::Approx(0.85));
}

TEST_CASE("reference reflectance: the example file follows its formula") {
  const auto table = read_reference_reflectance(std::string(GONIO_SOURCE_DIR) + "/examples/data/white-by-formula.csv");
  for (int theta = 0; theta <= 90; theta += 10) {
    const double expected = 0.99 * (1.0 - 0.15 * std::pow(std::sin(gonio::radians(theta)), 4));
    CHECK(std::abs(table.at(pair_at(theta, 20)).x() - expected) <= 0.5001e-4);
  }
}

TEST_CASE("reference reflectance: bad tables are refused") {
  const scratch::folder here;
  const auto refuses = [&](const std::string& text, const std::string& words) {
    CAPTURE(text);
    scratch::check_refused([&] { return read(here, text); }, {"white.csv", words});
  };
  refuses("", "has no theta_i");
  refuses("theta_i,factor\n", "has no theta_i");
  refuses("theta_i\n0\n", "line 1: column 'factor' is missing");
  refuses("factor\n0.9\n", "line 1: column 'theta_i' is missing");
  refuses("theta_i,factor_r,factor_b\n", "column 'factor_g' is missing");
  refuses("theta_i,factor,factor_r\n", "factors are given in two ways");
  refuses("theta_i,reflectance\n", "column 'reflectance' is unknown");
  refuses("theta_i,factor,theta_i\n", "column 'theta_i' appears twice");
  refuses("theta_i,factor\n0\n", "line 2: 1 field, expected 2");
  refuses("theta_i,factor [nm]\n", "column 'factor [nm]' is unknown");
  refuses("theta_i;factor\n0;0,9\n80;0.8\n", "line 3: column factor: '0.8' has a decimal point");
  refuses("theta_i,factor\n0,nan\n", "line 2: column factor: 'nan' is not finite");
  refuses("theta_i,factor\n0,white\n", "line 2: column factor: 'white' is not a number");
  refuses("theta_i,factor\n0,0.9\n0,0.9\n", "expected ascending angles");
  refuses("theta_i,factor\n30,0.9\n0,0.9\n", "expected ascending angles");
  refuses("theta_i,factor\n-10,0.9\n", "expected 0 to 90");
  refuses("theta_i,factor\n0,-0.9\n", "factor of -0.900000");
  refuses("theta_i,factor\n0,99\n", "expected above 0 and up to 1.5");
  refuses("theta_i,theta_o,factor\n0,0,1\n0,60,1\n30,0,1\n30,50,1\n",
          "line 5: theta_i 30 and theta_o 50, expected 30 and 60");
  refuses("theta_i,theta_o,factor\n0,0,1\n0,60,1\n30,0,1\n40,0,1\n", "line 5: theta_i 40 and theta_o 0");
  refuses("theta_i,theta_o,factor\n0,0,1\n0,60,1\n30,0,1\n", "has 3 factors, expected 4");
  refuses("theta_i,theta_o,factor\n0,60,1\n0,0,1\n", "expected ascending angles");
  scratch::check_refuses_non_files([](const auto& path) { return read_reference_reflectance(path); });
}
