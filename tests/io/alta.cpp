#include "scratch.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/measurements/alta.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <initializer_list>
#include <string>

using gonio::direction_pair;
using gonio::io::read_alta;
using scratch::check_refused;

namespace {

std::string header(const std::string& dimensions, const std::string& input, const std::string& output) {
  return "# made up\n#DIM " + dimensions + "\n#VS 0\n#PARAM_IN  " + input + "\n#PARAM_OUT " + output + "\n";
}

const std::string plain = header("3 1", "ISOTROPIC_TV_TL_DPHI", "INV_STERADIAN");

direction_pair directions_of(const std::string& dimensions, const std::string& input, const std::string& row) {
  const auto samples = read_alta(header(dimensions, input, "INV_STERADIAN") + row + "\n", "x");
  REQUIRE(samples.size() == 1);
  return samples[0].directions.pair();
}

void check_alta_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_alta(text, "tape.dat"); }, {"tape.dat"});
  check_refused([&] { return read_alta(text, "tape.dat"); }, words);
}

}  // namespace

TEST_CASE("ALTA: the same pair of directions in each parametrisation") {
  // Light at 0.5 from the normal along x, viewer at 0.25 and an azimuth of 2.
  const direction_pair expected{gonio::spherical_direction(0.5, 0.0), gonio::spherical_direction(0.25, 2.0)};
  const gonio::half_difference angles = gonio::to_half_difference(expected.wi, expected.wo);
  const auto check = [&](const direction_pair& pair) {
    const gonio::half_difference found = gonio::to_half_difference(pair.wi, pair.wo);
    CHECK(found.theta_h == doctest::Approx(angles.theta_h));
    CHECK(found.theta_d == doctest::Approx(angles.theta_d));
    CHECK(gonio::polar_angle(pair.wi) == doctest::Approx(0.5));
    CHECK(gonio::polar_angle(pair.wo) == doctest::Approx(0.25));
  };
  const direction_pair spherical = directions_of("4 1", "SPHERICAL_TL_PL_TV_PV", "0.5 0.75 0.25 2.75 1");
  check(spherical);
  CHECK(gonio::azimuth(spherical.wi) == doctest::Approx(0.75));
  check(directions_of("3 1", "ISOTROPIC_TV_TL_DPHI", "0.25\t0.5\t2\t1"));
  check(
      directions_of("3 1", "ISOTROPIC_TL_TV_PROJ_DPHI",
                    "0.5 " + std::to_string(0.25 * std::cos(2.0)) + " " + std::to_string(0.25 * std::sin(2.0)) + " 1"));
  const auto numbers = [](const gonio::direction& w) {
    return std::to_string(w.x()) + " " + std::to_string(w.y()) + " " + std::to_string(w.z()) + " ";
  };
  check(directions_of("6 1", "CARTESIAN", numbers(expected.wo) + numbers(expected.wi) + "1"));
  // The difference vector is the viewer's: half a turn from the light's, unless phi_d was folded, which exchanges both.
  const bool is_folded = gonio::polar_angle(gonio::to_directions(angles).wi) < 0.4;
  const std::string theta_h = std::to_string(angles.theta_h), theta_d = std::to_string(angles.theta_d),
                    phi_d = std::to_string(angles.phi_d - (is_folded ? 0.0 : 3.14159265));
  check(directions_of("3 1", "RUSIN_TH_TD_PD", theta_h + " " + theta_d + " " + phi_d + " 1"));
  const direction_pair turned =
      directions_of("4 1", "RUSIN_TH_PH_TD_PD", theta_h + " 1.5 " + theta_d + " " + phi_d + " 1");
  check(turned);
  CHECK(gonio::azimuth(turned.wi + turned.wo) == doctest::Approx(1.5));
}

TEST_CASE("ALTA: the mirror direction is where azimuths differ by half a turn") {
  const auto at = [](const std::string& row) {
    const direction_pair pair = directions_of("3 1", "ISOTROPIC_TL_TV_PROJ_DPHI", row);
    return gonio::to_half_difference(pair.wi, pair.wo).theta_h;
  };
  CHECK(at("0.5 -0.5 0 1") < 1e-6);
  CHECK(at("0.5 0.5 0 1") == doctest::Approx(0.5));
}

TEST_CASE("ALTA: the header states the quantity of the values") {
  const auto first = [](const std::string& dimensions, const std::string& output, const std::string& values) {
    return read_alta(header(dimensions, "ISOTROPIC_TV_TL_DPHI", output) + "0.25 0.5 2 " + values + "\n# end\n", "x")
        .colours()[0]
        .value;
  };
  CHECK((first("3 1", "INV_STERADIAN", ".5") == 0.5).all());
  CHECK((first("3 3", "RGB_COLOR", ".1 .2 -.3") == gonio::rgb(0.1, 0.2, -0.3)).all());
  CHECK(first("3 1", "INV_STERADIAN_COSINE_FACTOR", ".5").isApprox(gonio::rgb::Constant(0.5 / std::cos(0.25)), 1e-6));
  CHECK(first("3 3", "XYZ_COLOR", "1 2 3").isApprox(gonio::from_xyz({1, 2, 3}), 1e-6));
  CHECK((first("3 1", "INV_STERADIAN", ".5 .4 .6") == 0.5).all());                 // a confidence interval
  CHECK(read_alta(plain + "0.25 1.5708 2 1\n0.25 0.5 2 1\n\n", "x").size() == 1);  // at the horizon
}

TEST_CASE("ALTA: a file is recognised by its header") {
  CHECK(gonio::io::looks_like_alta(plain));
  CHECK(gonio::io::looks_like_alta("#PARAM_IN X\r\n#DIM\t3 1\r\n"));
  CHECK_FALSE(gonio::io::looks_like_alta("#DIM 3 1\n0 0 0 1\n#PARAM_IN X\n"));
  CHECK_FALSE(gonio::io::looks_like_alta("# PARAM_IN\n# DIM\ntheta_i,theta_o,brdf\n"));
}

TEST_CASE("ALTA: bad files are refused") {
  check_alta_refused("", {"no line of numbers"});
  check_alta_refused(plain, {"no line of numbers"});
  check_alta_refused("#DIM 3 1\n#PARAM_OUT INV_STERADIAN\n0 0 0 1\n", {"line 3", "no line #PARAM_IN"});
  check_alta_refused("#DIM 3 1\n#PARAM_IN RUSIN_TH_TD_PD\n0 0 0 1\n", {"line 3", "#PARAM_OUT INV_STERADIAN"});
  check_alta_refused("#DIM 3\n", {"line 1", "#DIM: '3', expected two counts"});
  check_alta_refused("#DIM 3 1e9\n", {"line 1", "'1e9'", "from 1 to 16"});
  check_alta_refused("#PARAM_IN COS_TH\n", {"line 1", "'COS_TH'", "RUSIN_TH_TD_PD or"});
  check_alta_refused("#PARAM_OUT ENERGY\n", {"line 1", "'ENERGY'", "INV_STERADIAN or"});
  check_alta_refused("#FORMAT binary\n", {"line 1", "'binary'", "expected text"});
  check_alta_refused(header("4 1", "RUSIN_TH_TD_PD", "INV_STERADIAN") + "0 0 0 0 1\n",
                     {"#DIM states 4 and 1 numbers, expected 3 for #PARAM_IN RUSIN_TH_TD_PD and 1"});
  check_alta_refused(header("3 1", "RUSIN_TH_TD_PD", "RGB_COLOR") + "0 0 0 1\n", {"and 3 for #PARAM_OUT RGB_COLOR"});
  check_alta_refused(plain + "0.1 0.2 0.3\n", {"line 6", "3 numbers, expected 4"});
  check_alta_refused(plain + "0.1 0.2 0.3 1 2 3 4\n", {"line 6", "7 numbers, expected 4"});
  check_alta_refused(plain + "0.1 0.2 x 1\n", {"line 6", "number 3", "'x'"});
  check_alta_refused(plain + "0.1 0.2 0.3 nan\n", {"line 6", "number 4", "not finite"});
  check_alta_refused(plain + "0.1 0.2 0.3 1e39\n", {"line 6", "range of float"});
  check_alta_refused(plain + "45 0.2 0.3 1\n", {"line 6", "polar angle is 45", "degrees?"});
  check_alta_refused(plain + "0.1 0.2 180 1\n", {"line 6", "azimuth is 180"});
  check_alta_refused(header("6 1", "CARTESIAN", "INV_STERADIAN") + "0 0 1 0 0 2 1\n", {"line 6", "length 2"});
  check_alta_refused(plain + "1.5708 0.2 0.3 1\n", {"no sample"});
  scratch::check_refuses_non_files([](const auto& path) { return read_alta(path); });
}

TEST_CASE("ALTA: any text is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-e \n#")));
    try {
      for (const gonio::sample& s : read_alta(plain + text, "x")) RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
