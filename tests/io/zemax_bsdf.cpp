#include "scratch.hpp"
#include <gonio/io/measurements/zemax_bsdf.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

using gonio::degrees;
using gonio::radians;
using gonio::io::read_zemax_bsdf;
using scratch::check_refused;

namespace {

std::string zemax_header(const std::string& spectral_content, const std::string& scatter_type = "BRDF") {
  return "# made up\r\nSource\tMeasured\r\nSymmetry PlaneSymmetrical\r\nSpectralContent " + spectral_content +
         "\r\nScatterType " + scatter_type +
         "\r\nSampleRotation 1\r\n0\r\nAngleOfIncidence 2\r\n0 40\r\nScatterAzimuth 3\r\n0\t90 180\r\n"
         "ScatterRadial 3\r\n0 30\r\n60\r\n\r\n";
}

/// A block of rows for each of the two angles of incidence; the numbers count up from the first.
std::string zemax_blocks(const std::string& channel, int first) {
  std::string text = channel + "\nDataBegin\n";
  for (int block = 0; block < 2; ++block) {
    text += "TIS 0.5\n";
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) text += std::to_string(first + 9 * block + 3 * row + column) + ' ';
      text += '\n';
    }
  }
  return text + "DataEnd\n";
}

const std::string small_file = zemax_header("Monochrome") + zemax_blocks("Monochrome", 1);

void check_zemax_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_zemax_bsdf(text, "vinyl.bsdf"); }, {"vinyl.bsdf"});
  check_refused([&] { return read_zemax_bsdf(text, "vinyl.bsdf"); }, words);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("Zemax: angles are about the specular direction; azimuth 0 points to the normal") {
  const auto samples = read_zemax_bsdf(small_file, "vinyl.bsdf");
  // Seven directions for normal incidence; at 40 degrees azimuth 180 leads to 70 and to 100 degrees, below the horizon.
  REQUIRE(samples.size() == 13);
  const auto check = [](const gonio::sample& s, double theta_i, double theta_o, double value) {
    const auto& [wi, wo] = s.directions.pair();
    CHECK(degrees(gonio::polar_angle(wi)) == doctest::Approx(theta_i));
    CHECK(degrees(gonio::polar_angle(wo)) == doctest::Approx(theta_o));
    CHECK((s.value == value).all());
    CHECK(s.weight == 1.0);
  };
  check(samples[0], 0.0, 0.0, 1.0);
  check(samples[1], 0.0, 30.0, 2.0);
  check(samples[2], 0.0, 60.0, 3.0);
  check(samples[7], 40.0, 40.0, 10.0);  // the specular direction, once
  check(samples[8], 40.0, 10.0, 11.0);
  check(samples[9], 40.0, 20.0, 12.0);  // on the light's side of the normal
  check(samples[12], 40.0, 70.0, 17.0);
  CHECK(samples[7].directions.pair().wo.x() == doctest::Approx(-std::sin(radians(40.0))));
  CHECK(samples[9].directions.pair().wo.x() == doctest::Approx(std::sin(radians(20.0))));
  // To the side: azimuth 90 is perpendicular to the plane of incidence.
  const gonio::direction& side = samples[10].directions.pair().wo;
  CHECK(side.y() == doctest::Approx(std::sin(radians(30.0))));
  CHECK(side.z() == doctest::Approx(std::cos(radians(30.0)) * std::cos(radians(40.0))));
}

TEST_CASE("Zemax: three planes of CIE XYZ become linear Rec. 709") {
  const auto samples = read_zemax_bsdf(zemax_header("XYZ") + zemax_blocks("TristimulusX", 1) +
                                           zemax_blocks("TristimulusY", 3) + zemax_blocks("TristimulusZ", 5),
                                       "vinyl.bsdf");
  REQUIRE(samples.size() == 13);
  CHECK((samples[1].value - gonio::from_xyz({2.0, 4.0, 6.0})).abs().maxCoeff() < 1e-12);
}

TEST_CASE("Zemax: azimuth 360 is azimuth 0, and the sample's rotation turns both directions") {
  const std::string text =
      "SpectralContent Monochrome ScatterType BRDF SampleRotation 1 90 AngleOfIncidence 1 40 ScatterAzimuth 3 0 180 "
      "360 "
      "ScatterRadial 1 10\nMonochrome TIS 0 1 2 3";
  const auto samples = read_zemax_bsdf(text, "x");
  REQUIRE(samples.size() == 2);
  CHECK((samples[0].value == 1.0).all());
  CHECK(samples[0].directions.pair().wi.y() == doctest::Approx(std::sin(radians(40.0))));
  CHECK(samples[0].directions.pair().wo.y() == doctest::Approx(-std::sin(radians(30.0))));
}

TEST_CASE("Zemax: bad files are refused") {
  check_zemax_refused("", {"ends before the data"});
  check_zemax_refused("# only\n", {"ends before the data"});
  check_zemax_refused("theta_i,phi_i\n", {"line 1", "'theta_i,phi_i'", "keyword"});
  check_zemax_refused(zemax_header("RGB"), {"line 4", "'RGB'", "Monochrome or XYZ"});
  check_zemax_refused(zemax_header("Monochrome", "BTDF"), {"line 5", "transmission"});
  check_zemax_refused("Monochrome\n", {"SampleRotation is missing"});
  check_zemax_refused(replaced(small_file, "ScatterRadial 3\r\n0 30\r\n60", ""), {"ScatterRadial is missing"});
  check_zemax_refused(replaced(small_file, "AngleOfIncidence 2", "AngleOfIncidence 3"),
                      {"line 10", "AngleOfIncidence", "'ScatterAzimuth'"});
  check_zemax_refused(replaced(small_file, "AngleOfIncidence 2", "AngleOfIncidence 1e300"), {"line 8", "not a count"});
  check_zemax_refused(replaced(small_file, "AngleOfIncidence 2", "AngleOfIncidence 0.5"), {"line 8", "not a count"});
  check_zemax_refused(replaced(small_file, "0 40", "0 nan"), {"line 9", "AngleOfIncidence", "not finite"});
  check_zemax_refused(replaced(small_file, "0 40", "0 95"), {"line 9", "'95'", "from 0 to 90"});
  check_zemax_refused(replaced(small_file, "TIS 0.5", "0.5"), {"line 18", "'0.5'", "expected TIS"});
  check_zemax_refused(replaced(small_file, "1 2 3", "1 two 3"), {"line 19", "BRDF", "'two'", "not a number"});
  check_zemax_refused(replaced(small_file, "1 2 3", "1 1e39 3"), {"line 19", "1e+39", "range of float"});
  check_zemax_refused(small_file.substr(0, small_file.size() - 20), {"ends before BRDF"});
  check_zemax_refused(small_file + "7\n", {"'7' follows the data"});
  check_zemax_refused(replaced(zemax_header("XYZ") + zemax_blocks("TristimulusX", 1), "TristimulusX", "TristimulusY"),
                      {"'TristimulusY'", "TristimulusX"});
  check_zemax_refused(
      "SpectralContent Monochrome SampleRotation 1 0 AngleOfIncidence 1 90 ScatterAzimuth 1 0 ScatterRadial 1 0\n"
      "Monochrome TIS 1 2",
      {"no sample above the horizon"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_zemax_bsdf(path); });
}

TEST_CASE("Zemax: a direction has the given radial angle; azimuth 0 is nearest to the normal") {
  CHECK(rc::check([](unsigned a, unsigned b, unsigned c, unsigned d) {
    const auto angle = [](unsigned number, double range) { return range * (number % 1000u) / 1000.0; };
    const double theta = angle(a, 1.5), phi = angle(b, 6.0), radial = 0.01 + angle(c, 1.5), azimuth = angle(d, 6.2);
    const gonio::direction wo = gonio::io::detail::about_specular(theta, phi, radial, azimuth);
    const gonio::direction specular = gonio::spherical_direction(theta, phi + std::numbers::pi);
    RC_ASSERT(std::abs(wo.norm() - 1.0) < 1e-12);
    RC_ASSERT(std::abs(gonio::angle_between(wo, specular) - radial) < 1e-9);
    // Azimuth 0 is nearest to the normal, 180 degrees furthest.
    const double nearest = gonio::io::detail::about_specular(theta, phi, radial, 0.0).z();
    if (radial < theta) RC_ASSERT(wo.z() <= nearest + 1e-12);
  }));
}

TEST_CASE("Zemax: a measured vinyl shows signal up to the same polar angle for all angles of incidence") {
  // tests/workflows/example_models/test_13_planesymmetric_brdf_zemax.bsdf of github.com/ansys/optical-automation
  const scratch::fs::path path = GONIO_SHARED_DATA "/field-formats/brown_vinyl.bsdf";
  if (!scratch::fs::exists(path)) {
    MESSAGE("skipped: there is no " << path.string());
    return;
  }
  const auto samples = gonio::io::read_zemax_bsdf(path);
  REQUIRE(samples.size() == 2131);
  std::map<double, double> largest;
  for (const gonio::sample& s : samples) {
    const auto& [wi, wo] = s.directions.pair();
    double& theta = largest[std::round(degrees(gonio::polar_angle(wi)))];
    if (s.value.y() > 0.02) theta = std::max(theta, degrees(gonio::polar_angle(wo)));
  }
  CHECK(largest.size() == 13);
  for (const auto& [theta_i, theta_o] : largest) {
    CAPTURE(theta_i);
    // The instrument measures up to 84 degrees, and the grid has a direction within a few degrees. If azimuth 0 pointed
    // away from the normal, there would be signal far below the horizon.
    CHECK(theta_o > 82.0);
    CHECK(theta_o < 86.0);
  }
}
