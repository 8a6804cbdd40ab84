#include "scratch.hpp"
#include <gonio/io/measurements/speos_brdf.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <string>

using gonio::degrees;
using gonio::io::read_speos_brdf;
using scratch::check_refused;

namespace {

const std::string rows = "OPTIS - brdf surface file v9.0\r\n0\r\n# a comment\r\n9\r\ntwo\nlines\r\n1\t0\r\n";

/// A table of one value at polar angles from 0 to 90 degrees and the listed azimuths.
std::string flat(const std::string& value, const std::string& azimuths, int count) {
  std::string text = "10 " + std::to_string(count) + "\n\t" + azimuths + "\n";
  for (int theta = 0; theta <= 90; theta += 10) {
    text += std::to_string(theta);
    for (int k = 0; k < count; ++k) text += "\t" + value;
    text += "\n";
  }
  return text;
}

const std::string small = rows + "1\n1 1\n30\n550\n50\n" + flat("7", "0 90 180 270 360", 5);

const std::string all_azimuths = "0 90 180 270 360";

/// Anisotropy angle 0 with 10 and 30 degrees of incidence, 30 with 40.
const std::string anisotropic =
    "OPTIS - Anisotropic BSDF surface file v11\n0\n\n0\n\n0\t1\t0\n1\t0\n1\n2\n0\t30\n2\n10\t30\n1\n40\n15\t0\n\n"
    "2\n400\t42\n700\t84\n" +
    flat("7", all_azimuths, 5) + flat("14", all_azimuths, 5) + flat("3.5", all_azimuths, 5);

/// All degrees from 0 to 360.
std::string fine_azimuths() {
  std::string text;
  for (int phi = 0; phi <= 360; ++phi) text += std::to_string(phi) + " ";
  return text;
}

void check_speos_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_speos_brdf(text, "paint.brdf"); }, {"paint.brdf"});
  check_refused([&] { return read_speos_brdf(text, "paint.brdf"); }, words);
}

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  REQUIRE(text.find(old) != std::string::npos);
  return text.replace(text.find(old), old.size(), fresh);
}

}  // namespace

TEST_CASE("Speos: a flat table is a diffuser of the file's reflectance") {
  const double expected = 0.5 / std::numbers::pi;
  const auto samples = read_speos_brdf(small, "x");
  REQUIRE(samples.size() == 1 + 8 * 4);  // the normal, and 10 to 80 degrees
  CHECK(samples.channels() == gonio::channels({550.0}));
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(samples[i].value.x() == doctest::Approx(expected).epsilon(1e-3));
  // Half a turn, and a turn without its end.
  CHECK(read_speos_brdf(rows + "1\n1 1\n30\n550\n50\n" + flat("7", "0 90 180", 3), "x")[3].value.x() ==
        doctest::Approx(expected).epsilon(1e-3));
  CHECK(read_speos_brdf(rows + "1\n1 1\n30\n550\n50\n" + flat("7", "0 90 180 270", 4), "x")[3].value.x() ==
        doctest::Approx(expected).epsilon(1e-3));
}

TEST_CASE("Speos: tables of intensities include the cosine") {
  const auto samples = read_speos_brdf(with(small, "1\n1 1\n", "0\n1 1\n"), "x");
  // The integral of a constant over the hemisphere is 2 pi.
  CHECK(samples[0].value.x() == doctest::Approx(0.5 / (2.0 * std::numbers::pi)).epsilon(1e-3));
  const double theta = gonio::polar_angle(samples[20].directions.pair().wo);
  CHECK(samples[20].value.x() * std::cos(theta) == doctest::Approx(samples[0].value.x()).epsilon(1e-6));
}

TEST_CASE("Speos: azimuth 0 is the mirror direction's side, wavelengths make spectra") {
  const std::string both = rows + "1\n2 2\n0 30\n450 550.5\n10\n" + flat("1", "0 180 360", 3) + "20\n" +
                           flat("3", "0 180 360", 3) + "30\n" + flat("1", "0 180 360", 3) + "40\n" +
                           flat("1", "0 180 360", 3);
  const auto samples = read_speos_brdf(both, "x");
  REQUIRE(samples.size() == 2 * (1 + 8 * 2));
  CHECK(samples.channels() == gonio::channels({450.0, 550.5}));
  CHECK(samples.values(3)[1] == doctest::Approx(2.0 * samples.values(3)[0]));
  CHECK(samples.values(20)[1] == doctest::Approx(4.0 / 3.0 * samples.values(20)[0]));
  const auto& [wi, wo] = samples.directions(17 + 5).pair();  // 30 degrees, azimuth 0
  CHECK(degrees(gonio::polar_angle(wo)) == doctest::Approx(30.0));
  CHECK((wi + wo).normalized().z() == doctest::Approx(1.0));
}

TEST_CASE("Speos: one spectrum scales all tables of an anisotropic file") {
  const double white = 1.0 / std::numbers::pi;
  const auto read = read_speos_brdf(anisotropic, "x");
  CHECK(read.channels() == gonio::channels({400.0, 700.0}));
  REQUIRE(read.size() == 3 * (1 + 8 * 4));
  // A table of doubled values reflects twice as much. The spectrum belongs to 15 degrees, between the tables of 7
  // and 14.
  const double scale = white / 8.75;
  CHECK(read.values(0)[0] == doctest::Approx(0.42 * 7.0 * scale).epsilon(1e-3));
  CHECK(read.values(0)[1] == doctest::Approx(0.84 * 7.0 * scale).epsilon(1e-3));
  CHECK(read.values(33)[0] == doctest::Approx(0.42 * 14.0 * scale).epsilon(1e-3));
  CHECK(read.values(66)[1] == doctest::Approx(0.84 * 3.5 * scale).epsilon(1e-3));
  const auto samples = read.in_three_channels();
  const auto azimuths = [&](int i) {
    const auto& [wi, wo] = samples[i].directions.pair();
    return std::pair(degrees(gonio::azimuth(wi)), degrees(gonio::azimuth(wo)));
  };
  CHECK(azimuths(1).first == doctest::Approx(180.0));
  CHECK(azimuths(2).second == doctest::Approx(90.0));
  CHECK(azimuths(67).first == doctest::Approx(150.0));  // less the anisotropy angle of 30 degrees
  CHECK(azimuths(67).second == doctest::Approx(-30.0));
  CHECK(degrees(gonio::polar_angle(samples[33].directions.pair().wi)) == doctest::Approx(30.0));
  // Outside all angles of incidence the nearest applies; titles and a last line are optional.
  CHECK(read_speos_brdf(with(anisotropic, "\n15\t0\n\n", "\n5 0\nReflection Spectrum\n") + "End of file\n", "x")
            .values(0)[0] == doctest::Approx(0.42 * white).epsilon(1e-3));
  CHECK(read_speos_brdf(with(anisotropic, "\n15\t0\n", "\n80 0\n"), "x").values(33)[0] ==
        doctest::Approx(0.42 * white).epsilon(1e-3));
  // Intensities include the cosine.
  const auto flat_intensities = read_speos_brdf(with(anisotropic, "\n1\t0\n1\n", "\n1\t0\n0\n"), "x");
  CHECK(flat_intensities.values(1)[0] / flat_intensities.values(29)[0] ==
        doctest::Approx(std::cos(gonio::radians(80.0)) / std::cos(gonio::radians(10.0))));
}

TEST_CASE("Speos: bad anisotropic files are refused") {
  check_speos_refused(with(anisotropic, "0\t1\t0", "0\tup\t0"), {"line 6", "the anisotropy vector", "'up'"});
  check_speos_refused(with(anisotropic, "\n1\t0\n1\n", "\n1\t1\n1\n"), {"line 7", "transmission"});
  check_speos_refused(with(anisotropic, "\n2\n0\t30\n", "\n2e9\n0\t30\n"), {"line 9", "anisotropy angles", "'2e9'"});
  check_speos_refused(with(anisotropic, "\n0\t30\n", "\n0\t0\n"), {"line 10", "an anisotropy angle: 0 follows 0"});
  check_speos_refused(with(anisotropic, "\n10\t30\n", "\n10\t95\n"), {"line 12", "an angle of incidence: '95'"});
  check_speos_refused(with(anisotropic, "\n15\t0\n", "\n20\t10\n"), {"line 15", "angle 10 is not among the angles"});
  check_speos_refused(with(anisotropic, "\n15\t0\n", "\n120\t0\n"),
                      {"line 15", "spectrum's angle of incidence: '120'"});
  check_speos_refused(with(anisotropic, "\n700\t84\n", "\n400\t84\n"), {"line 19", "a wavelength: '400'"});
  check_speos_refused(with(anisotropic, "\n700\t84\n", "\n700\t184\n"), {"line 19", "the reflectance", "184"});
  check_speos_refused(with(anisotropic, "\t7\t7", "\t7\tx"), {"line 22", "a value", "'x'"});
  check_speos_refused(anisotropic + "1\n", {"continues after its last table"});
  check_speos_refused(anisotropic.substr(0, anisotropic.size() - 5), {"ends before a value"});
  check_speos_refused(with(anisotropic, "\n2\n400", "\n20000\n400"), {"line 17", "the number of wavelengths: '20000'"});
  // A small file of many wavelengths and many values would give too many numbers.
  std::string wide = "\n5000\n";
  for (int i = 1; i <= 5000; ++i) wide += std::to_string(i) + " 1\n";
  check_speos_refused(with(with(anisotropic, "\n2\n400\t42\n700\t84\n", wide), flat("7", all_azimuths, 5),
                           flat("7", fine_azimuths(), 361)),
                      {"has 3710 values and a spectrum of 5000 wavelengths", "too many"});
}

TEST_CASE("Speos: a file is recognised by its header") {
  CHECK(gonio::io::looks_like_speos_brdf(small));
  CHECK(gonio::io::looks_like_speos_brdf(anisotropic));
  CHECK_FALSE(gonio::io::looks_like_speos_brdf("OPTIS - Polarizer surface file v9.0\n"));
}

TEST_CASE("Speos: bad files are refused") {
  check_speos_refused("", {"ends after line 0", "seven rows"});
  check_speos_refused("a\n", {"line 1", "OPTIS - brdf surface file"});
  check_speos_refused(with(small, "\r\n0\r\n", "\r\n1\r\n"), {"line 2", "'1'", "expected 0, text"});
  check_speos_refused(with(small, "\r\n9\r\n", "\r\n9e9\r\n"), {"line 4", "9e+09 characters"});
  check_speos_refused(with(small, "1\t0", "1\t1"), {"line 7", "transmission", "'1 0'"});
  check_speos_refused(with(small, "1\t0", "0\t1"), {"line 7", "transmission"});
  check_speos_refused(with(small, "1\n1 1\n", "2\n1 1\n"), {"line 8", "'2'", "0 or 1"});
  check_speos_refused(with(small, "1\n1 1\n", "1\n1.5 1\n"), {"line 9", "angles of incidence", "not a whole number"});
  check_speos_refused(with(small, "1\n1 1\n", "1\n1e9 1\n"), {"line 9", "'1e9'", "from 1 to 10000"});
  check_speos_refused(with(small, "\n30\n", "\n91\n"), {"line 10", "angle of incidence", "91"});
  check_speos_refused(with(small, "\n50\n", "\n101\n"), {"line 12", "reflectance", "101", "from 0 to 100"});
  check_speos_refused(with(small, "0 90 180 270", "0 90 80 270"), {"line 14", "phi", "80 follows 90"});
  check_speos_refused(with(small, "\n20\t", "\n5\t"), {"line 17", "theta", "5", "from 10 to 90"});
  check_speos_refused(with(small, "\t7", "\tx"), {"line 15", "a value", "'x'"});
  check_speos_refused(with(small, "\t7", "\tnan"), {"not finite"});
  check_speos_refused(small.substr(0, small.size() - 3), {"ends before a value"});
  check_speos_refused(small + "1\n", {"line 25", "continues after its last table"});
  const std::string start = rows + "1\n1 1\n30\n550\n50\n";
  check_speos_refused(start + flat("0", "0 180 360", 3), {"reflects no light"});
  check_speos_refused(start + flat("1", "0 90", 2), {"phi covers 90 degrees"});
  check_speos_refused(rows + "1\n1 2\n30\n450 550\n50\n" + flat("1", "0 180 360", 3) + "50\n" + flat("1", "0 180", 2),
                      {"other directions"});
  scratch::check_refuses_non_files([](const auto& path) { return read_speos_brdf(path); });
}

TEST_CASE("Speos: any text is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-e \n#")));
    std::string all = *rc::gen::element(small, anisotropic);
    all.resize(*rc::gen::inRange<std::size_t>(rows.size(), all.size()));
    try {
      for (const gonio::sample& s : read_speos_brdf(all + text, "x").in_three_channels())
        RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
