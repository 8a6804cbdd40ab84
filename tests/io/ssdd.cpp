#include "scratch.hpp"
#include <gonio/core/spectrum.hpp>
#include <gonio/io/measurements/ssdd.hpp>

#include <rapidcheck.h>

#include <array>

using gonio::degrees;
using gonio::io::read_ssdd;
using scratch::check_refused;

namespace {

/// A block of BRDF up to its numbers.
std::string brdf_block(const std::string& colour_model, const std::string& coordinates, const std::string& lists) {
  return "DATA_TYPE brdf\nCOLOR_MODEL " + colour_model + "\nPARAM_TYPE " + coordinates + "\n" + lists + "DATA ";
}

const std::string small_lists = "PARAM0_LIST 0 40 90 # degrees\nPARAM2_LIST 0 30\nPARAM3_LIST 0 180 360\n";
const std::string numbers_to_18 = "ascii\n# PARAM3: 0\n1 2 3\n4 5 6\n7 8 9\n10 11 12\n13 14 15\n16 17 18\n";
const std::string ssdd_start = "VERSION 0.3\nSOFTWARE made up\nDATE 2026-01-01\n\n";

std::string spherical_file() {
  return ssdd_start + brdf_block("monochrome", "spherical_coordinate_system", small_lists) + numbers_to_18;
}

void check_ssdd_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_ssdd(text, "metal.ssdd"); }, {"metal.ssdd"});
  check_refused([&] { return read_ssdd(text, "metal.ssdd"); }, words);
}

void check_angles(const gonio::sample& s, double theta_i, double theta_o, double value) {
  CHECK(degrees(gonio::polar_angle(s.directions.pair().wi)) == doctest::Approx(theta_i));
  CHECK(degrees(gonio::polar_angle(s.directions.pair().wo)) == doctest::Approx(theta_o));
  CHECK((s.value == value).all());
}

}  // namespace

TEST_CASE("SSDD: the first list varies fastest, each direction is read once, and none at the horizon") {
  const auto samples = read_ssdd(spherical_file(), "metal.ssdd");
  REQUIRE(samples.size() == 6);
  check_angles(samples[0], 0.0, 0.0, 1.0);
  check_angles(samples[1], 40.0, 0.0, 2.0);
  check_angles(samples[2], 0.0, 30.0, 4.0);
  check_angles(samples[3], 40.0, 30.0, 5.0);
  check_angles(samples[5], 40.0, 30.0, 11.0);
  CHECK(samples[3].directions.pair().wo.x() > 0.0);  // on the light's side
  CHECK(samples[5].directions.pair().wo.x() < 0.0);
}

TEST_CASE("SSDD: angles about the specular direction, and half and difference angles, are read") {
  const auto specular = read_ssdd(
      ssdd_start + brdf_block("monochrome", "specular_coordinate_system", small_lists) + numbers_to_18, "metal.ssdd");
  REQUIRE(specular.size() == 6);
  check_angles(specular[1], 40.0, 40.0, 2.0);
  check_angles(specular[3], 40.0, 10.0, 5.0);
  check_angles(specular[5], 40.0, 70.0, 11.0);
  const auto half = read_ssdd(ssdd_start +
                                  brdf_block("monochrome", "half_difference_coordinate_system",
                                             "PARAM0_LIST 20\nPARAM1_LIST 0 90\nPARAM2_LIST 30\nPARAM3_LIST 90\n") +
                                  "ascii\n1\n2\n",
                              "metal.ssdd");
  REQUIRE(half.size() == 2);
  for (const gonio::sample& s : half) {
    CHECK(degrees(s.angles().theta_h) == doctest::Approx(20.0));
    CHECK(degrees(s.angles().theta_d) == doctest::Approx(30.0));
    CHECK(degrees(s.angles().phi_d) == doctest::Approx(90.0));
  }
}

TEST_CASE("SSDD: colours are read as text and in binary, other blocks are skipped") {
  const std::string one = "PARAM0_LIST 10\nPARAM2_LIST 20\nPARAM3_LIST 30\n";
  const auto colour_of = [&](const std::string& model, const std::string& more, const std::string& data) {
    const auto samples =
        read_ssdd(ssdd_start + brdf_block(model, "spherical_coordinate_system", one + more) + data, "metal.ssdd");
    REQUIRE(samples.size() == 1);
    return samples.colours()[0].value;
  };
  CHECK((colour_of("rgb", "", "ascii\n1 2 3") == gonio::rgb(1, 2, 3)).all());
  CHECK(colour_of("xyz", "", "ascii\n1 2 3").isApprox(gonio::from_xyz({1, 2, 3}), 1e-14));
  const std::array wavelengths{450.0, 550.0, 650.0}, values{0.1, 0.2, 0.4};
  const gonio::rgb expected = gonio::spectral_colour(wavelengths)(values);
  CHECK((colour_of("spectrum", "WAVELENGTH_LIST 450 550 650\n", "ascii\n.1 .2 .4") == expected).all());
  const std::string spectral =
      ssdd_start + brdf_block("spectrum", "spherical_coordinate_system", one + "WAVELENGTH_LIST 450 550 650\n") +
      "ascii\n.1 .2 .4";
  const auto spectra = gonio::io::read_ssdd(spectral, "metal.ssdd");
  CHECK(spectra.channels() == gonio::channels({wavelengths.begin(), wavelengths.end()}));
  CHECK(spectra.values(0)[2] == doctest::Approx(0.4));

  const std::array<float, 3> numbers{0.5f, 0.25f, -1.0f};
  const std::string binary(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
  const std::string specular =
      "\nDATA_TYPE specular_reflectance\nCOLOR_MODEL monochrome\nPARAM0_LIST 0 90\nDATA ascii\n";
  CHECK((colour_of("rgb", "NAME of\n", "binary\n" + binary + specular + "0.05\n0.05\n") == gonio::rgb(0.5, 0.25, -1.0))
            .all());
  check_ssdd_refused(ssdd_start + brdf_block("rgb", "spherical_coordinate_system", one) + "binary\n" + binary + "1",
                     {"'1'", "DATA_TYPE"});
  check_ssdd_refused(ssdd_start + brdf_block("rgb", "spherical_coordinate_system", one) + "binary\n1234",
                     {"has 4 bytes", "3 times 4"});
  check_ssdd_refused(
      ssdd_start + brdf_block("monochrome", "spherical_coordinate_system", one) + "binary\n\xFF\xFF\xFF\xFF",
      {"not finite"});
}

TEST_CASE("SSDD: bad files are refused") {
  const auto with = [](const std::string& what, const std::string& by) {
    std::string text = spherical_file();
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
  };
  check_ssdd_refused("", {"ends before VERSION"});
  check_ssdd_refused("DATA_TYPE brdf\n", {"line 1", "expected VERSION"});
  check_ssdd_refused("VERSION 1.0\n", {"line 1", "'1.0'"});
  check_ssdd_refused("VERSION 0.3\nCOLOUR red\n", {"line 2", "'COLOUR'"});
  check_ssdd_refused("VERSION 0.3\n", {"ends before"});
  check_ssdd_refused(
      ssdd_start + "DATA_TYPE specular_reflectance\nCOLOR_MODEL monochrome\nPARAM0_LIST 0\nDATA ascii\n1\n",
      {"no block of DATA_TYPE brdf"});
  check_ssdd_refused(with("brdf", "bssrdf"), {"'bssrdf'", "brdf or btdf"});
  check_ssdd_refused(with("COLOR_MODEL monochrome\n", ""), {"COLOR_MODEL is missing"});
  check_ssdd_refused(with("monochrome", "spectrum"), {"WAVELENGTH_LIST is missing"});
  check_ssdd_refused(with("monochrome", "spectrum\nWAVELENGTH_LIST 1000 2000"), {"ends before a colour"});
  check_ssdd_refused(with("PARAM_TYPE spherical_coordinate_system\n", ""), {"PARAM_TYPE is missing"});
  check_ssdd_refused(with("spherical_coordinate_system", "distorted_spherical_coordinate_system"), {"distorted"});
  check_ssdd_refused(with("PARAM2_LIST 0 30\n", ""), {"PARAM2_LIST is missing"});
  check_ssdd_refused(with("PARAM2_LIST 0 30", "PARAM2_LIST 0 130"), {"PARAM2_LIST", "130", "at most 90"});
  check_ssdd_refused(with("0 40 90", "0 40 100"), {"PARAM0_LIST", "100", "at most 90"});
  check_ssdd_refused(with("0 40 90", "0 forty 90"), {"line 8", "PARAM0_LIST", "'forty'"});
  check_ssdd_refused(with("DATA ascii", "PARAM4_LIST 1 2 3\nDATA ascii"), {"PARAM4_LIST", "not supported"});
  check_ssdd_refused(with("ascii", "text"), {"'text'", "ascii or binary"});
  check_ssdd_refused(with("7 8 9", "7 eight 9"), {"'eight'", "a colour"});
  check_ssdd_refused(with("16 17 18", "16 17"), {"ends before a colour"});
  check_ssdd_refused(with("16 17 18", "16 17 18 19"), {"'19'", "DATA_TYPE"});
  check_ssdd_refused(with("1 2 3", "1e39 2 3"), {"range of float"});
  std::string twice = spherical_file();
  twice += twice.substr(twice.find("DATA_TYPE"));
  check_ssdd_refused(twice, {"second block"});
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_ssdd(path); });
}

TEST_CASE("SSDD: a damaged file is read or refused") {
  const std::string whole = spherical_file();
  CHECK(rc::check([&] {
    std::string text = whole;
    for (int i = 0; i < 3; ++i)
      text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::elementOf(std::string("0123456789.-# \ne"));
    try {
      for (const gonio::sample& s : read_ssdd(text, "x")) RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
