#include "scratch.hpp"
#include <gonio/io/measurements/openmaterial.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>

#include <cmath>
#include <numbers>
#include <string>

using gonio::degrees;
using gonio::rgb;
using gonio::io::read_openmaterial;
using gonio::io::write_openmaterial;
using scratch::check_refused;

namespace {

std::string file_of(const std::string& rows) {
  return "{\"metadata\": {\"name\": \"x\", \"openMaterial3dVersion\": \"1.0.0\"},\n\"brdf\": {\"wavelengths\": "
         "[9e-07],\n"
         "\"lookupTable\": [\n" +
         rows + "\n]}}\n";
}

gonio::sample_set read_text(const std::string& rows) {
  return read_openmaterial(file_of(rows), "asphalt_brdf.xompt").colours();
}

void check_xompt_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_openmaterial(text, "asphalt_brdf.xompt"); }, {"asphalt_brdf.xompt"});
  check_refused([&] { return read_openmaterial(text, "asphalt_brdf.xompt"); }, words);
}

/// A BRDF of -0.5 everywhere.
struct negative_brdf {
  rgb operator()(const gonio::direction&, const gonio::direction&) const noexcept { return rgb::Constant(-0.5); }
};

}  // namespace

TEST_CASE("OpenMATERIAL: rows of one wavelength are grey samples of light and viewer") {
  const auto samples = read_text("[9.05e-07, 0.5, 0.25, 3.141593, 0.02],\n[9.05e-07, 0.5, 0.75, 1.570796, 0.03]");
  REQUIRE(samples.size() == 2);
  CHECK(gonio::polar_angle(samples[0].directions.pair().wi) == doctest::Approx(0.5));
  CHECK(gonio::polar_angle(samples[0].directions.pair().wo) == doctest::Approx(0.25));
  CHECK(samples[0].directions.pair().wo.x() < 0.0);  // on the mirror direction's side
  CHECK(degrees(gonio::azimuth(samples[1].directions.pair().wo)) == doctest::Approx(90.0));
  CHECK((samples[0].value == 0.02).all());
  CHECK((samples[1].value == 0.03).all());
}

TEST_CASE("OpenMATERIAL: the receiver's solid angle gives its cone") {
  const auto file_with = [](const std::string& angles) {
    return "{\"brdf\": {\"wavelengths\": [9e-7], \"receiverSolidAngles\": " + angles +
           ", \"lookupTable\": [[9e-7, 0.5, 0.25, 3, 0.02]]}}";
  };
  const auto samples =
      read_openmaterial(file_with("[{\"wavelength\": 9e-7, \"solidAngle\": 0.001}, {\"solidAngle\": 0.003}]"), "x");
  CHECK(samples.aperture(0).source == 0.0);
  CHECK(degrees(samples.aperture(0).receiver) == doctest::Approx(1.4459).epsilon(1e-4));  // of 0.002 sr
  CHECK(!read_openmaterial(file_with("[]"), "x").have_apertures());
  check_xompt_refused(file_with("[{\"solidAngle\": 3}]"), {"line 1", "the receiver has a solid angle of 3"});
}

TEST_CASE("OpenMATERIAL: a pair of directions is one sample; rows with null or at the horizon are skipped") {
  const auto samples = read_text(
      "[9e-7, 0, 0.25, 0, 0.1], [9e-7, 0, 0.25, 1.5, 0.3], [9e-7, 0.4, 0.25, 0, 1], [9e-7, 0.4, 0.25, 6.283185, 3],"
      "[9e-7, 0.4, 0.25, 1, null], [null, 0.4, 0.2, 1, 5], [9e-7, 1.570796, 0.25, 1, 7], [9e-7, 0.4, 1.570796, 1, 7]");
  REQUIRE(samples.size() == 2);
  CHECK(samples[0].value[0] == doctest::Approx(0.2));
  CHECK(samples[1].value[0] == doctest::Approx(2.0));
}

TEST_CASE("OpenMATERIAL: limits that were rounded up are accepted") {
  const auto samples = read_text(
      "[9e-7, 0.4, 0.2, 6.2832, 1], [9e-7, 1.5708, 0.2, 1, 7], [9e-7, 0.4, 1.5708, 1, 7], [17.16e-3, 0.4, 0.2, 0, "
      "null]");
  REQUIRE(samples.size() == 1);
  CHECK(gonio::azimuth(samples[0].directions.pair().wo) == doctest::Approx(0.0));
  CHECK(read_openmaterial(file_of("[17.16e-3, 0.4, 0.2, 0, 1]"), "x").channels().name(0) == "17160000 nm");
}

TEST_CASE("OpenMATERIAL: wavelengths in metres make a colour, in any order") {
  const auto flat = read_text("[4.5e-7, 0.4, 0.2, 0, 0.3], [5.5e-7, 0.4, 0.2, 0, 0.3], [6.5e-7, 0.4, 0.2, 0, 0.3]");
  REQUIRE(flat.size() == 1);
  CHECK((flat[0].value - 0.3).abs().maxCoeff() < 1e-6);
  const auto red = read_text("[6.5e-7, 0.4, 0.2, 0, 0.3], [5.5e-7, 0.4, 0.2, 0, 0.1], [4.5e-7, 0.4, 0.2, 0, 0.1]");
  CHECK(red[0].value[0] > 1.5 * red[0].value[2]);
  const auto spectra =
      gonio::io::read_openmaterial(file_of("[6.5e-7, 0.4, 0.2, 0, 0.3], [5.5e-7, 0.4, 0.2, 0, 0.1]"), "red_brdf.xompt");
  REQUIRE(spectra.channels().size() == 2);
  CHECK(spectra.channels().wavelengths()[0] == doctest::Approx(550.0));
  CHECK(spectra.values(0)[1] == 0.3);
}

TEST_CASE("OpenMATERIAL: a written table has the material's colours") {
  const gonio::model::ggx gold{.alpha = 0.5, .f0 = rgb(0.9, 0.6, 0.3)};
  const std::string text = write_openmaterial(gold, {.name = "gold \"leaf\""}, {6, 8});
  CHECK(gonio::io::looks_like_openmaterial(text.substr(0, 1000)));
  for (const char* words : {"\"name\": \"gold \\\"leaf\\\"\"", "without the cosine", "\"license\": \"NOASSERTION\"",
                            "\"wavelengths\": [380e-9, 400e-9,", "[380e-9, 1.570796, 1.570796, 6.283185, "})
    CHECK_MESSAGE(text.find(words) != std::string::npos, words);
  const auto samples = read_openmaterial(text, "gold_brdf.xompt").colours();
  CHECK(samples.size() == 1 + 5 + 5 + 5 * 5 * 8);
  double worst = 0.0;
  for (const auto& each : samples) {
    const auto pair = each.directions.pair();
    worst = std::max(worst, (each.value / gold(pair.wi, pair.wo) - 1.0).abs().maxCoeff());
  }
  CHECK(worst < 0.02);  // renderers interpolate spectra linearly, our samples use trapezoids
  CHECK(write_openmaterial(gold, {.name = "gold \"leaf\""}, {6, 8}, gonio::thread_count{3}) == text);
}

TEST_CASE("OpenMATERIAL: identifiers follow from name and numbers") {
  const gonio::model::lambertian grey{.albedo = rgb::Constant(0.5)}, white{.albedo = rgb::Constant(0.9)};
  const auto uuid = [](const std::string& text) {
    const std::size_t at = text.find("\"uuid\": \"") + 9;
    return text.substr(at, text.find('"', at) - at);
  };
  const std::string one = uuid(write_openmaterial(grey, {.name = "a"}, {2, 2}));
  REQUIRE(one.size() == 36);
  CHECK(one[8] == '-');
  CHECK(one[14] == '8');
  CHECK(std::string("89ab").find(one[19]) != std::string::npos);
  CHECK(uuid(write_openmaterial(grey, {.name = "a"}, {2, 2})) == one);
  CHECK(uuid(write_openmaterial(grey, {.name = "b"}, {2, 2})) != one);
  CHECK(uuid(write_openmaterial(white, {.name = "a"}, {2, 2})) != one);
}

TEST_CASE("OpenMATERIAL: negative values become 0, and a file's name must end in _brdf.xompt") {
  const std::string text = write_openmaterial(negative_brdf{}, {}, {1, 1});
  CHECK(text.find(", -") == std::string::npos);
  CHECK(text.find(", 0]") != std::string::npos);
  const scratch::folder here;
  gonio::io::write_openmaterial(here / "t_brdf.xompt", text);
  CHECK(scratch::get(here / "t_brdf.xompt") == text);
  check_refused([&] { return gonio::io::write_openmaterial(here / "t.xompt", text), 0; }, {"t.xompt", "_brdf.xompt"});
  CHECK(here.entries() == 1);
  const gonio::model::lambertian grey{.albedo = rgb::Constant(0.5)};
  check_refused([&] { return write_openmaterial(grey, {}, {61, 1}); }, {"1 to 60", "61"});
  check_refused([&] { return write_openmaterial(grey, {}, {1, 0}); }, {"1 to 120"});
}

TEST_CASE("OpenMATERIAL: bad files are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_openmaterial(path); });
  check_xompt_refused(file_of("[9e-7, 0.4, 0.2, 0]"), {"line 4", "4 numbers, expected 5"});
  check_xompt_refused(file_of("[9e-7, 0.4, 0.2, 0, 1, 2]"), {"more than 5"});
  check_xompt_refused(file_of("[905, 0.4, 0.2, 0, 1]"), {"wavelength", "905"});
  check_xompt_refused(file_of("[9e-7, 40, 0.2, 0, 1]"), {"zenith angle of the light", "40"});
  check_xompt_refused(file_of("[9e-7, 0.4, -0.2, 0, 1]"), {"zenith angle of the viewer", "-0.2"});
  check_xompt_refused(file_of("[9e-7, 0.4, 0.2, 180, 1]"), {"azimuth", "180"});
  check_xompt_refused(file_of("[9e-7, 0.4, 0.2, 0, 1e39]"), {"range of float"});
  check_xompt_refused(file_of("[9e-7, 0.4, 0.2, 0, \"x\"]"), {"line 4"});
  check_xompt_refused(file_of(""), {"no sample above the horizon"});
  check_xompt_refused("{\"metadata\": {}, \"opticalProperties\": []}", {"no brdf.lookupTable"});
  check_xompt_refused("{\"brdf\": {\"lookupTable\": [], \"lookupTable\": []}}", {"appears twice"});
  check_xompt_refused("{\"brdf\": {", {"cut off"});
  CHECK(!gonio::io::looks_like_openmaterial("{\"metadata\": {}, \"data\": {}}"));
  CHECK(!gonio::io::looks_like_openmaterial("theta_i, \"lookupTable\""));
}
