#include "scratch.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/measurements/bird.hpp>

#include <rapidcheck.h>

#include <array>

using gonio::io::read_bird;
using scratch::check_refused;

namespace {

/// `"name":{"unit":"unit","values":[values]` without the last brace, so that more entries can follow.
std::string opened(const std::string& name, const std::string& unit, const std::string& values) {
  return "\"" + name + "\":{\"unit\":\"" + unit + "\",\"values\":[" + values + "]";
}

std::string variable(const std::string& name, const std::string& unit, const std::string& values) {
  return opened(name, unit, values) + "}";
}

/// Two measurements in one pair of directions, then one in another.
const std::string three_directions = variable("theta_i", "deg", "30,30,0") + "," + variable("phi_i", "deg", "0,0,0") +
                                     "," + variable("theta_r", "\xC2\xB0", "60,60,45") + "," +
                                     variable("phi_r", "deg", "180,180,90");

std::string bird_file(const std::string& data) {
  return "{\"metadata\":{\"type\":\"BRDF\"},\n\"data\":{" + data + "}}";
}

std::string three_of(const std::string& more, const std::string& brdf = variable("BRDF", "sr^-1", "0.1,0.3,0.5")) {
  return bird_file(three_directions + "," + brdf + (more.empty() ? "" : ",") + more);
}

void check_bird_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_bird(text, "tile.json"); }, {"tile.json"});
  check_refused([&] { return read_bird(text, "tile.json"); }, words);
}

}  // namespace

TEST_CASE("BiRD: repeats are averaged, directions are degrees or radians") {
  const auto samples = read_bird(three_of(""), "tile.json");
  REQUIRE(samples.size() == 2);
  const auto& [wi, wo] = samples[0].directions.pair();
  CHECK(gonio::degrees(gonio::polar_angle(wi)) == doctest::Approx(30.0));
  CHECK(gonio::degrees(gonio::polar_angle(wo)) == doctest::Approx(60.0));
  CHECK(wo.x() < 0.0);
  CHECK(samples[0].value.y() == doctest::Approx(0.2));
  CHECK((samples[1].value == 0.5).all());
  CHECK(samples[0].weight == 1.0);
  const auto radians = read_bird(bird_file(variable("theta_i", "rad", "0.5") + "," + variable("phi_i", "rad", "0") +
                                           "," + variable("theta_r", "rad", "0.25") + "," +
                                           variable("phi_r", "rad", "3") + "," + variable("BRDF", "1/sr", "1")),
                                 "tile.json");
  CHECK(gonio::polar_angle(radians[0].directions.pair().wi) == doctest::Approx(0.5));
}

TEST_CASE("BiRD: wavelengths in one pair of directions make a spectrum, in any order") {
  const auto at_one_direction = [](const std::string& count, const std::string& wavelengths, const std::string& brdf) {
    return bird_file(variable("theta_i", "deg", count) + "," + variable("phi_i", "deg", count) + "," +
                     variable("theta_r", "deg", count) + "," + variable("phi_r", "deg", count) + "," + wavelengths +
                     "," + variable("BRDF", "sr^-1", brdf));
  };
  const std::array wavelengths{450.0, 550.0, 650.0}, values{0.1, 0.2, 0.4};
  const gonio::rgb expected = gonio::spectral_colour(wavelengths)(values);
  for (const std::string& given :
       {variable("wavelength_i", "nm", "550,450,650"), variable("wavelength_r", "\xCE\xBCm", "0.55,0.45,0.65")}) {
    const auto samples = read_bird(at_one_direction("45,45,45", given, "0.2,0.1,0.4"), "x");
    REQUIRE(samples.size() == 1);
    CHECK((samples.colours()[0].value - expected).abs().maxCoeff() < 1e-9);
    CHECK(samples.channels() == gonio::channels({wavelengths.begin(), wavelengths.end()}));
    CHECK(samples.values(0)[2] == 0.4);
  }
  CHECK(read_bird(three_of(""), "x").channels() == gonio::channels::one_value());
  // Other wavelengths in the next pair of directions make colours.
  CHECK(read_bird(three_of(variable("wavelength_i", "nm", "450,550,450")), "x").channels().are_colours());
  const auto laser = read_bird(at_one_direction("45", variable("wavelength_i", "nm", "1064"), "0.2"), "x");
  CHECK((laser[0].value == 0.2).all());
  CHECK_FALSE(read_bird(at_one_direction("45,45", variable("wavelength_i", "nm", "1000,1064"), "0.2,0.1"), "x")
                  .channels()
                  .have_colour());
}

TEST_CASE("BiRD: states of illumination must average to unpolarised light") {
  const auto states = [](const std::string& values) { return "\"polarization_i\":{\"values\":[" + values + "]}"; };
  for (const std::string& fine : {states("\"s\",\"p\",\"u\""), states("[1,1,0,0],[1,-1,0,0],[1,0,0,0]")})
    CHECK(read_bird(three_of(fine), "x")[0].value.y() == doctest::Approx(0.2));
  check_bird_refused(three_of(states("\"s\",\"s\",\"u\"")), {"theta_i 30", "theta_r 60", "as much s as p"});
  check_bird_refused(three_of(states("\"s\",\"p\",\"p\"")), {"theta_i 0", "as much s as p"});
  check_bird_refused(three_of(states("\"s\",\"p\",\"x\"")), {"'x'", "Stokes"});
  check_bird_refused(three_of(states("[1,0,0],[1,0,0,0],\"u\"")), {"4 numbers"});
  check_bird_refused(three_of(states("[1,0,0,0,0],[1,0,0,0],\"u\"")), {"4 numbers"});
  check_bird_refused(three_of(states("[1,0,2,0],[1,0,0,0],\"u\"")), {"from -1 to 1"});
  check_bird_refused(three_of(states("[0.5,0,0,0],[1,0,0,0],\"u\"")), {"the first 1"});
  check_bird_refused(three_of(states("\"s\",\"p\"")), {"polarization_i has 2 values", "expected 3"});
  const std::string analysed = "\"polarization_r\":{\"notation\":\"sp\",\"values\":[\"u\",\"u\",\"p\"]}";
  check_bird_refused(three_of(analysed), {"polarization_r", "analysed"});
}

TEST_CASE("BiRD: weights follow from relative uncertainty; the median has weight 1") {
  const auto weights = [](const std::string& more, const std::string& brdf = variable("BRDF", "sr^-1", "0.1,0.3,0.5")) {
    const auto samples = read_bird(three_of(more, brdf), "x");
    return std::array{samples[0].weight[0], samples[1].weight[0]};
  };
  // 1 and 2 percent: the median is 1.5.
  const auto percent = weights(variable("uBRDF", "%", "1,1,2"), variable("BRDF", "sr^-1", "0.2,0.2,0.5"));
  CHECK(percent[0] == doctest::Approx(2.25));
  CHECK(percent[1] == doctest::Approx(2.25 / 4.0));
  // 0.01 is 5 percent of 0.2 and 2 percent of 0.5.
  const auto absolute = weights(variable("uBRDF", "1/sr", "0.01,0.01,0.01"));
  CHECK(absolute[0] == doctest::Approx(3.5 * 3.5 / 25.0));
  CHECK(absolute[1] == doctest::Approx(3.5 * 3.5 / 4.0));
  const auto constant =
      weights("", opened("BRDF", "sr^-1", "0.1,0.3,0.5") + ",\"uncertainty\":{\"value\":0.01,\"unit\":\"sr^-1\"}}");
  CHECK(constant[0] == doctest::Approx(absolute[0]));
  CHECK(weights(variable("uBRDF", "%", "0,0,0"))[0] == 1.0);
  CHECK(weights(variable("uBRDF", "%", "0,0,2"))[0] == 100.0);
  CHECK(weights(variable("uBRDF", "1/sr", "1,1,1"), variable("BRDF", "sr^-1", "1,1,0"))[1] == 0.01);
  check_bird_refused(three_of(variable("uBRDF", "%", "1,-1,1")), {"uncertainty of -1 is negative"});
  check_bird_refused(three_of(variable("uBRDF", "mm", "1,1,1")), {"uBRDF", "'mm'", "sr^-1 or %"});
}

TEST_CASE("BiRD: bad files are refused") {
  check_bird_refused("", {"cut off"});
  check_bird_refused("[]", {"line 1", "the file: expected an object"});
  check_bird_refused("{}", {"no object 'data'"});
  check_bird_refused("{\"data\":{},\"data\":{}}", {"'data' appears twice"});
  check_bird_refused("{\"data\":{}}", {"data.BRDF is missing"});
  check_bird_refused("{\"data\":{\"variables\":[],\"values\":[]}}", {"draft", "schema 1.0"});
  check_bird_refused(three_of("") + "x", {"'x' follows"});
  check_bird_refused(three_of("").substr(0, 200), {"cut off"});
  check_bird_refused(bird_file(three_directions), {"data.BRDF is missing"});
  check_bird_refused(bird_file(variable("BRDF", "sr^-1", "1")), {"data.theta_i is missing"});
  check_bird_refused(three_of(variable("theta_i", "deg", "1")), {"'theta_i' appears twice"});
  check_bird_refused(three_of("", variable("BRDF", "sr^-1", "1,2")), {"data.phi_i has 3 values", "expected 2"});
  check_bird_refused(three_of("", variable("BRDF", "%", "1,2,3")), {"data.BRDF", "'%'", "sr^-1"});
  check_bird_refused(three_of("", variable("BRDF", "sr^-1", "1,true,3")), {"line 2", "BRDF", "'true'"});
  check_bird_refused(three_of("", variable("BRDF", "sr^-1", "1,1e39,3")), {"measurement 2", "range of float"});
  check_bird_refused(three_of(variable("wavelength_i", "m", "1,1,1")), {"wavelengths", "'m'"});
  check_bird_refused(
      three_of(variable("wavelength_i", "nm", "500,500,500") + "," + variable("wavelength_r", "nm", "600,600,600")),
      {"fluorescence"});
  check_bird_refused(three_of("\"adhoc_variables\":{\"heat\":{\"values\":[20,20,30]}}"), {"'heat' varies"});
  CHECK(read_bird(three_of("\"adhoc_variables\":{\"heat\":{\"unit\":\"K\",\"values\":[20,20,20]}}"), "x").size() == 2);
  const auto at = [](const std::string& theta, const std::string& unit, const std::string& phi) {
    return bird_file(variable("theta_i", unit, theta) + "," + variable("phi_i", unit, phi) + "," +
                     variable("theta_r", unit, "1") + "," + variable("phi_r", unit, "1") + "," +
                     variable("BRDF", "sr^-1", "1"));
  };
  check_bird_refused(at("95", "deg", "0"), {"measurement 1", "theta_i of 95", "0 to 90"});
  check_bird_refused(at("45", "rad", "0"), {"theta_i of 2578", "0 to 90"});
  check_bird_refused(at("45", "deg", "400"), {"phi_i of 400", "0 to 360"});
  check_bird_refused(at("45", "gon", "0"), {"data.theta_i", "'gon'", "deg or rad"});
  check_bird_refused(at("90", "deg", "0"), {"no sample above the horizon"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_bird(path); });
}

TEST_CASE("BiRD: a damaged file is read or refused") {
  const std::string whole =
      three_of(variable("uBRDF", "%", "1,1,2") + ",\"polarization_i\":{\"values\":[\"s\",\"p\",[1,0,0,0]]}");
  CHECK(rc::check([&] {
    std::string text = whole;
    for (int i = 0; i < 3; ++i)
      text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::elementOf(std::string("0123456789.-,:{}[]\"e"));
    try {
      for (const gonio::sample& s : read_bird(text, "x")) {
        RC_ASSERT(s.value.isFinite().all());
        RC_ASSERT(s.weight[0] >= 0.01 && s.weight[0] <= 100.0);
      }
    } catch (const gonio::error&) {
    }
  }));
}

TEST_CASE("BiRD: the consortium's example has one pair of directions at four wavelengths, in s and p") {
  // "Test BRDF data files/example.brdf" of github.com/BiRD-project/BiRD_view
  const scratch::fs::path path = GONIO_SHARED_DATA "/field-formats/bird_example.brdf";
  if (!scratch::fs::exists(path)) {
    MESSAGE("skipped: there is no " << path.string());
    return;
  }
  const auto samples = gonio::io::read_bird(path);
  REQUIRE(samples.size() == 1);
  CHECK(gonio::degrees(gonio::polar_angle(samples.directions(0).pair().wo)) == doctest::Approx(10.0));
  const std::array wavelengths{550.0, 650.0, 750.0, 850.0}, values{0.2585, 0.27, 0.288, 0.2985};
  CHECK((samples.colours()[0].value - gonio::spectral_colour(wavelengths)(values)).abs().maxCoeff() < 1e-9);
}

TEST_CASE("BiRD: solid angle and divergence give the cones of receiver and source") {
  const auto with = [](const std::string& receiver, const std::string& beam) {
    return "{\"metadata\":{\"type\":\"BRDF\",\"instrumentation\":{\"name\":\"x\",\"illumination_system\":{\"beam\":{" +
           beam + "}},\"detection_system\":{\"sensors\":[{\"value\":7}],\"solid_angle\":{\"unit\":\"sr\",\"value\":" +
           receiver + "}}}},\"data\":{" + three_directions + "," + variable("BRDF", "sr^-1", "0.1,0.3,0.5") + "}}";
  };
  const auto samples = read_bird(with("0.002194", "\"divergence\":{\"value\":0.5,\"unit\":\"deg\"}"), "tile.json");
  CHECK(gonio::degrees(samples.aperture(1).receiver) == doctest::Approx(1.5144).epsilon(1e-4));
  CHECK(gonio::degrees(samples.aperture(1).source) == doctest::Approx(0.25));
  const auto in_radians = read_bird(with("0", "\"divergence\":{\"unit\":\"rad\",\"value\":0.02}"), "tile.json");
  CHECK(in_radians.aperture(0) == gonio::aperture{0.01, 0.0});
  CHECK(!read_bird(with("0", "\"shape\":\"circular\""), "tile.json").have_apertures());
  check_bird_refused(with("7", ""), {"the receiver has a solid angle of 7", "expected from 0 to 1.84"});
  check_bird_refused(with("0", "\"divergence\":{\"value\":200,\"unit\":\"deg\"}"),
                     {"the beam has a divergence of 200 deg", "0 to 90"});
}
