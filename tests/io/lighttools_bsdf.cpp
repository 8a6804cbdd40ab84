#include "scratch.hpp"
#include <gonio/core/rgb.hpp>
#include <gonio/io/measurements/lighttools_bsdf.hpp>
#include <gonio/io/measurements/zemax_bsdf.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <initializer_list>
#include <string>

using gonio::degrees;
using gonio::io::read_lighttools_bsdf;
using scratch::check_refused;

namespace {

const std::string header =
    "# made up\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 4\n90 180 270 -270\n"
    "ScatterRadial 3\n0 30 90\nDataBegin\n";

std::string block(const std::string& keywords, const std::string& first = "1") {
  return keywords + "\nTIS 0.5\n" + first + " 2 3\n1 5 6\n1 8 9\n1 2 3\n";
}

const std::string good = header + block("AOI 20\nPOI 0\nSide Front\nWavelength 550\nScatterType BRDF") + "DataEnd\n";

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  REQUIRE(text.find(old) != std::string::npos);
  return text.replace(text.find(old), old.size(), fresh);
}

void check_lighttools_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_lighttools_bsdf(text, "paint.bsdf"); }, {"paint.bsdf"});
  check_refused([&] { return read_lighttools_bsdf(text, "paint.bsdf"); }, words);
}

}  // namespace

TEST_CASE("LightTools: a value for each azimuth and polar angle; the light is at azimuth 90") {
  const auto read = read_lighttools_bsdf(good, "x");
  CHECK(read.channels().wavelengths() == std::vector{550.0});
  const auto samples = read.in_three_channels();
  // The normal and azimuth 90 (-270) are read once, the horizon is skipped.
  REQUIRE(samples.size() == 4);
  CHECK(samples[0].value.x() == 1.0);
  CHECK(samples[1].value.x() == 2.0);
  CHECK(samples[2].value.x() == 5.0);
  CHECK(samples[3].value.x() == 8.0);
  for (int i = 0; i < 4; ++i) {
    const auto& [wi, wo] = samples[i].directions.pair();
    CHECK(degrees(gonio::polar_angle(wi)) == doctest::Approx(20.0));
    CHECK(degrees(gonio::azimuth(wi)) == doctest::Approx(90.0));
    CHECK(degrees(gonio::polar_angle(wo)) == doctest::Approx(i == 0 ? 0.0 : 30.0).epsilon(1e-9));
  }
  CHECK(degrees(samples[1].angles().theta_d) == doctest::Approx(5.0));   // on the light's side
  CHECK(degrees(samples[3].angles().theta_d) == doctest::Approx(25.0));  // on the mirror direction's
}

TEST_CASE("LightTools: the front's reflection is read, the back's if there is no other") {
  const std::string front = block("AOI 20\nScatterType BRDF\nSide Front", "7"),
                    back = block("AOI 20\nScatterType BRDF\nSide Back", "4"),
                    through = block("AOI 20\nScatterType BTDF", "9");
  CHECK(read_lighttools_bsdf(header + through + back + front, "x")[0].value.x() == 7.0);
  CHECK(read_lighttools_bsdf(header + through + back, "x")[0].value.x() == 4.0);
  check_lighttools_refused(header + through, {"no block of ScatterType BRDF"});
}

TEST_CASE("LightTools: wavelengths make spectra, X, Y and Z a colour") {
  const auto at = [](const std::string& incidence, const std::string& wavelength, const std::string& first) {
    return block("AOI " + incidence + "\nWavelength " + wavelength, first);
  };
  const auto spectra = read_lighttools_bsdf(
      header + at("20", "650", "3") + at("10", "450", "4") + at("20", "450", "5") + at("10", "650", "6"), "x");
  REQUIRE(spectra.size() == 8);
  CHECK(spectra.channels().wavelengths() == std::vector{450.0, 650.0});
  CHECK(spectra.values(0)[0] == 4.0);
  CHECK(spectra.values(0)[1] == 6.0);
  CHECK(spectra.values(4)[0] == 5.0);
  CHECK(spectra.values(4)[1] == 3.0);
  const std::string xyz = with(header, "Monochrome", "XYZ");
  const auto part = [](const std::string& which, const std::string& first) {
    return block("AOI 20\nTristimulusValue Tris" + which, first);
  };
  const auto colours = read_lighttools_bsdf(xyz + part("Z", "3") + part("X", "1") + part("Y", "2"), "x");
  const gonio::rgb expected = gonio::from_xyz({1.0, 2.0, 3.0});
  for (int c = 0; c < 3; ++c) CHECK(colours[0].value[c] == doctest::Approx(expected[c]));
  check_lighttools_refused(xyz + part("X", "1") + part("Y", "1"), {"line 11", "AOI 20 has 2 blocks", "TrisZ"});
  check_lighttools_refused(xyz + block("AOI 20"), {"line 10", "no TristimulusValue"});
}

TEST_CASE("LightTools: a file is recognised by its keywords, Zemax's are not") {
  CHECK(gonio::io::looks_like_lighttools_bsdf(good));
  CHECK(gonio::io::looks_like_zemax_bsdf(good));
  CHECK_FALSE(gonio::io::looks_like_lighttools_bsdf(header + "TIS 0.5\n1 2 3"));
  CHECK_FALSE(gonio::io::looks_like_lighttools_bsdf("DataBegin AOI"));
  CHECK_FALSE(gonio::io::looks_like_lighttools_bsdf("Source Measured\n"));
}

TEST_CASE("LightTools: bad files are refused") {
  check_lighttools_refused("", {"ends before DataBegin"});
  check_lighttools_refused("Symmetry", {"ends before Symmetry"});
  check_lighttools_refused(with(good, "Symmetry ", "Symmetries "), {"line 2", "'Symmetries'", "above DataBegin"});
  check_lighttools_refused(with(good, "Monochrome", "RGB"), {"line 3", "'RGB'", "Monochrome or XYZ"});
  check_lighttools_refused(with(good, "ScatterAzimuth 4", "ScatterAzimuth 4e9"), {"line 4", "is not a count"});
  check_lighttools_refused(with(good, "90 180", "90 720"), {"line 5", "ScatterAzimuth", "'720'"});
  check_lighttools_refused(with(good, "0 30 90", "0 30 190"), {"line 7", "ScatterRadial", "'190'"});
  check_lighttools_refused("DataBegin\n", {"line 1", "ScatterAzimuth is missing"});
  check_lighttools_refused("ScatterAzimuth 1\n0\nDataBegin\n", {"line 3", "ScatterRadial is missing"});
  check_lighttools_refused(with(good, "AOI 20", "AOI 91"), {"line 9", "AOI: '91'", "from 0 to 90"});
  check_lighttools_refused(with(good, "POI 0", "POI 30"), {"line 10", "POI: 30", "expected a plane of incidence of 0"});
  check_lighttools_refused(with(good, "POI", "PIO"), {"line 10", "'PIO' is not a keyword of a block"});
  check_lighttools_refused(with(good, "Front", "Up"), {"line 11", "'Up'", "Front or Back"});
  check_lighttools_refused(with(good, "BRDF", "BSDF"), {"line 13", "'BSDF'", "BRDF or BTDF"});
  check_lighttools_refused(with(good, "TIS 0.5", "TIS much"), {"line 14", "TIS", "'much'"});
  check_lighttools_refused(with(good, "8 9", "x 9"), {"line 17", "a value", "'x'"});
  check_lighttools_refused(with(good, "8 9", "nan 9"), {"line 17", "not finite"});
  check_lighttools_refused(with(good, "8 9", "1e39 9"), {"line 17", "range of float"});
  check_lighttools_refused(with(good, "8 9", "8"), {"'DataEnd'"});
  check_lighttools_refused(with(good, "8 9", "8 9 10"), {"'3' is not a keyword"});
  check_lighttools_refused(good.substr(0, good.find("1 8")), {"ends before a value"});
  check_lighttools_refused(good + "1\n", {"line 20", "'1' follows DataEnd"});
  check_lighttools_refused(header + block("AOI 20") + block("AOI 20"), {"line 16", "second block", "AOI 20"});
  check_lighttools_refused(header + block("AOI 20\nWavelength 500") + block("AOI 30"),
                           {"line 17", "AOI 30 has 1 block,", "each wavelength"});
  check_lighttools_refused(header + block("AOI 20\nWavelength 500") + block("AOI 20"), {"line 17", "no Wavelength"});
  scratch::check_refuses_non_files([](const auto& path) { return read_lighttools_bsdf(path); });
}

TEST_CASE("LightTools: any text is read or refused") {
  CHECK(rc::check([] {
    auto text = good;
    const auto where = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto fresh = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.- \nATD#")));
    text.replace(where, *rc::gen::inRange<std::size_t>(0, 10), fresh);
    try {
      for (const gonio::sample& s : read_lighttools_bsdf(text, "x").in_three_channels())
        RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
