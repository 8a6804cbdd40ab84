#include "scratch.hpp"
#include <gonio/io/measurements/cornell.hpp>

#include <rapidcheck.h>

using gonio::io::read_cornell;
using scratch::check_refused;

namespace {

const std::string start = "# Paint\n\n# num wls\n3\n# wls\n450 550\n650\n";

void check_text_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_cornell(text, "paint.brdf"); }, {"paint.brdf"});
  check_refused([&] { return read_cornell(text, "paint.brdf"); }, words);
}

}  // namespace

TEST_CASE("Cornell: directions in radians, a reflectance for each wavelength") {
  const auto samples =
      read_cornell(start + "0.5 0 0.25 3.1 .1 .1 .1\r\n\t# and\n 0.5  1 0.25 -1.5 0 0 0.3\n", "x").colours();
  REQUIRE(samples.size() == 2);
  const auto expected =
      gonio::to_half_difference(gonio::spherical_direction(0.5, 0.0), gonio::spherical_direction(0.25, 3.1));
  CHECK(samples[0].angles().theta_h == doctest::Approx(expected.theta_h));
  CHECK(samples[0].angles().theta_d == doctest::Approx(expected.theta_d));
  CHECK(samples[0].angles().phi_d == doctest::Approx(expected.phi_d));
  CHECK(((samples[0].value - 0.1).abs() < 1e-6).all());
  CHECK(samples[0].weight == 1.0);
  CHECK(samples[1].value.x() > samples[1].value.y());  // light at 650 nanometres only
}

TEST_CASE("Cornell: bad files are refused") {
  check_text_refused("", {"the file ends after"});
  check_text_refused("# only\n", {"the file ends after"});
  check_text_refused("many\n", {"line 1", "'many'", "not a number"});
  check_text_refused("1\n", {"line 1", "number of wavelengths", "'1'"});
  check_text_refused("2.5\n", {"number of wavelengths"});
  check_text_refused("-3\n", {"number of wavelengths"});
  check_text_refused("1e300\n", {"number of wavelengths"});
  check_text_refused("3 4\n", {"number of wavelengths"});
  check_text_refused("3\n450 550\n", {"expected 3 wavelengths, the file ends after", "2"});
  check_text_refused("3\n450 550\n650 750\n", {"line 3", "more than the 3"});
  check_text_refused("3\n450 550 500\n", {"line 2", "wavelength 3"});
  check_text_refused("3\n450 550 nan\n", {"line 2", "field 3"});
  check_text_refused(start, {"no sample above the horizon"});
  check_text_refused(start + "0.5 0 0.25 3.1 .1 .1\n", {"line 8", "6 fields", "3 reflectances"});
  check_text_refused(start + "0.5 0 0.25 3.1 .1 .1 .1 .1\n", {"line 8", "8 fields"});
  check_text_refused(start + "0.5 0 0.25 3.1 .1 .1 inf\n", {"line 8", "field 7"});
  check_text_refused(start + "0.5 0 0.25 3.1 .1 .1 1e999\n", {"line 8", "field 7", "out of range"});
  check_text_refused(start + "0.5 0 0.25 3.1 .1 .1 -1e39\n", {"line 8", "field 7", "-1e+39", "range of float"});
  check_text_refused(start + "1.6 0 0.25 3.1 .1 .1 .1\n", {"line 8", "field 1", "1.6"});
  check_text_refused(start + "0.5 0 -0.25 3.1 .1 .1 .1\n", {"line 8", "field 3", "-0.25"});
  check_text_refused(start + "0.5 40 0.25 3.1 .1 .1 .1\n", {"line 8", "field 2", "40"});
  check_refused([] { return gonio::io::read_cornell("/nowhere/paint.brdf"); }, {"/nowhere/paint.brdf"});
}

TEST_CASE("Cornell: any text is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-+e \n#x")));
    const bool whole = *rc::gen::arbitrary<bool>();
    try {
      const auto samples = read_cornell(whole ? text : start + text, "x").colours();
      for (const gonio::sample& s : samples) RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}

TEST_CASE("Cornell: of two measured paints, one is red and one is blue") {
  const scratch::fs::path folder = GONIO_SHARED_DATA "/cornell";
  if (!scratch::fs::exists(folder)) {
    MESSAGE("skipped: there is no " << folder.string());
    return;
  }
  const auto red = gonio::io::read_cornell(folder / "garnet_red.brdf").colours();
  const auto blue = gonio::io::read_cornell(folder / "krylon_blue.brdf").colours();
  REQUIRE(red.size() == 1439);
  REQUIRE(blue.size() == 1439);
  const auto sum = [](const gonio::sample_set& samples) {
    gonio::rgb total = gonio::rgb::Zero();
    for (const gonio::sample& s : samples) total += s.value.min(0.1);
    return total;
  };
  CHECK(sum(red).x() > 1.5 * sum(red).y());
  CHECK(sum(blue).z() > 1.5 * sum(blue).x());
}

TEST_CASE("Cornell: spectra stay unchanged") {
  const std::string text = start + "0.5 0 0.25 3.1 .1 .2 .3\n0.5 1 0.25 -1.5 0 -1 0.3\n";
  const auto spectra = read_cornell(text, "x");
  CHECK(spectra.channels() == gonio::channels({450, 550, 650}));
  CHECK(spectra.values(0)[1] == 0.2);
  CHECK(spectra.values(1)[1] == -1.0);
  check_refused([] { return read_cornell("3\n450 550\n", "x"); }, {"expected 3 wavelengths, the file ends after"});
  check_refused([] { return read_cornell("/nowhere/paint.brdf"); }, {"/nowhere/paint.brdf"});
}
