#include "scratch.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/measurements/astm_e1392.hpp>
#include <gonio/io/measurements/cornell.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

using gonio::io::read_astm_e1392;
using scratch::check_refused;

namespace {

const std::string astm_start = "KEY VALUE\r\nSAMPLE made up\r\nNUM_POINTS 2\r\nVARS theta_i,phi_i,theta_s,phi_s,";

void check_astm_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_astm_e1392(text, "paint.astm"); }, {"paint.astm"});
  check_refused([&] { return read_astm_e1392(text, "paint.astm"); }, words);
}

}  // namespace

TEST_CASE("ASTM: directions are in radians; red, green and blue stay unchanged") {
  const auto samples =
      read_astm_e1392(astm_start + "R,G,B\r\n0.5,0,0.25,3.1,.1,.2,-.3\r\n\r\n0.5, 1, 0.25, -1.5, 1, 2, 3\n", "x");
  REQUIRE(samples.size() == 2);
  const auto& [wi, wo] = samples[0].directions.pair();
  CHECK(gonio::polar_angle(wi) == doctest::Approx(0.5));
  CHECK(gonio::polar_angle(wo) == doctest::Approx(0.25));
  CHECK(gonio::azimuth(wo) == doctest::Approx(3.1));
  CHECK((samples[0].value == gonio::rgb(0.1, 0.2, -0.3)).all());
  CHECK((samples[1].value == gonio::rgb(1, 2, 3)).all());
}

TEST_CASE("ASTM: the columns' names give their meaning") {
  const auto first = [](const std::string& columns, const std::string& row) {
    const auto samples = read_astm_e1392("VARS " + columns + "\n" + row + "\n", "x");
    REQUIRE(samples.size() == 1);
    return samples.colours()[0];
  };
  CHECK((first("theta_i,phi_i,theta_s,phi_s,BRDF", "0.5,0,0.25,3,.7").value == 0.7).all());
  CHECK(first("theta_i,phi_i,theta_s,phi_s,X,Y,Z", "0.5,0,0.25,3,1,2,3")
            .value.isApprox(gonio::from_xyz({1, 2, 3}), 1e-14));
  const std::array wavelengths{450.0, 550.0, 650.0}, values{0.1, 0.2, 0.4};
  const gonio::rgb colour = gonio::spectral_colour(wavelengths)(values);
  CHECK((first("theta_i,phi_i,theta_s,phi_s,450nm,550nm,650nm", "0.5,0,0.25,3,.1,.2,.4").value == colour).all());
  const std::string text = astm_start + "450nm,550nm\n0.5,0,0.25,3,.1,.2\n0.5,0,0.5,3,.3,.4\n";
  const auto spectra = gonio::io::read_astm_e1392(text, "x");
  CHECK(spectra.channels() == gonio::channels({450.0, 550.0}));
  CHECK(spectra.values(1)[1] == 0.4);
  CHECK(gonio::polar_angle(spectra.directions(1).pair().wo) == doctest::Approx(0.5));
  const auto of_one = [](const std::string& column) {
    return gonio::io::read_astm_e1392(astm_start + column + "\n0.5,0,0.25,3,.1\n0.5,0,0.5,3,.1\n", "x").channels();
  };
  CHECK(of_one("633nm") == gonio::channels({633.0}));
  CHECK(of_one("BRDF") == gonio::channels::one_value());
  const auto other_order = first("BRDF,phi_s,theta_s,phi_i,theta_i", ".7,3,0.25,0,0.5");
  CHECK(gonio::polar_angle(other_order.directions.pair().wi) == doctest::Approx(0.5));
}

TEST_CASE("ASTM: a file is recognised by its line VARS") {
  CHECK(gonio::io::looks_like_astm_e1392(astm_start + "BRDF\n"));
  CHECK(gonio::io::looks_like_astm_e1392("VARS\ttheta_i,phi_i,theta_s,phi_s,BRDF\n"));
  CHECK_FALSE(gonio::io::looks_like_astm_e1392("theta_i,phi_i,theta_o,phi_o,r,g,b\n"));
  CHECK_FALSE(gonio::io::looks_like_astm_e1392(std::string(5000, ' ') + astm_start));
}

TEST_CASE("ASTM: directions at the horizon are skipped") {
  CHECK(read_astm_e1392(astm_start + "BRDF\n0.5,0,1.5708,3,.1\n0.5,0,1.5,3,.1\n", "x").size() == 1);
}

TEST_CASE("ASTM: bad files are refused") {
  check_astm_refused("", {"ends before its line VARS"});
  check_astm_refused("KEY VALUE\n", {"ends before its line VARS"});
  check_astm_refused("NUM_POINTS many\n", {"line 1", "NUM_POINTS", "'many'"});
  check_astm_refused("VARS theta_i,phi_i,theta_s\n", {"line 1", "phi_s"});
  check_astm_refused("VARS theta_i,phi_i,theta_s,phi_s\n", {"line 1", "expected a column of values"});
  check_astm_refused(astm_start + "\n", {"line 4", "''"});
  check_astm_refused("VARS theta_i,phi_i,theta_s,phi_s,BRDF\n", {"no sample"});
  check_astm_refused(astm_start + "one,two\n", {"line 4", "'one'", "R,G,B"});
  check_astm_refused(astm_start + "500nm,400nm\n", {"line 4", "VARS", "wavelength 2"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,0.25,3\n", {"line 5", "4 fields", "expected 5"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,0.25,3,x\n", {"line 5", "'BRDF'", "'x'"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,0.25,3,nan\n", {"line 5", "'BRDF'", "not finite"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,0.25,3,1e39\n", {"line 5", "range of float"});
  check_astm_refused(astm_start + "BRDF\n45,0,0.25,3,1\n", {"line 5", "'theta_i'", "45", "degrees?"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,-0.25,3,1\n", {"line 5", "'theta_s'", "-0.25"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,0.25,180,1\n", {"line 5", "'phi_s'", "180"});
  check_astm_refused(astm_start + "BRDF\n0.5,0,0.25,3,1\n", {"1 lines of numbers", "NUM_POINTS 2"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_astm_e1392(path); });
}

TEST_CASE("ASTM: any text is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-,e \nVARS")));
    try {
      for (const gonio::sample& s : read_astm_e1392(astm_start + "BRDF\n" + text, "x"))
        RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}

TEST_CASE("ASTM: a paint converted from Cornell's other format gives the same samples") {
  const scratch::fs::path path = GONIO_SHARED_DATA "/cornell/garnet_red.brdf";
  if (!scratch::fs::exists(path)) {
    MESSAGE("skipped: there is no " << path.string());
    return;
  }
  std::ifstream file(path);
  std::string rows, header = "VARS theta_i,phi_i,theta_s,phi_s";
  std::vector<std::string> numbers;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    for (std::string field; fields >> field;) numbers.push_back(field);
  }
  const std::size_t count = std::stoul(numbers[0]);
  for (std::size_t i = 1; i <= count; ++i) header += "," + numbers[i] + "nm";
  for (std::size_t i = count + 1; i < numbers.size(); ++i)
    rows += numbers[i] + ((i - count) % (count + 4) == 0 ? "\n" : ",");
  const auto expected = gonio::io::read_cornell(path);
  const auto samples = read_astm_e1392(header + "\n" + rows, "garnet_red.astm");
  REQUIRE(samples.size() == expected.size());
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    CHECK(std::ranges::equal(samples.values(i), expected.values(i)));
    CHECK(samples.directions(i).angles().theta_h == expected.directions(i).angles().theta_h);
  }
}
