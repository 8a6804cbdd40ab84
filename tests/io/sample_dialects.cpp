// The dialects of files of samples that docs/reference/formats.md lists, each as small text.

#include "sample_text.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <string>
#include <string_view>
#include <vector>

using gonio::degrees;
using gonio::io::read_samples;
using scratch::check_text_refused;

namespace {

struct noted_samples {
  gonio::sample_set samples;
  std::vector<std::string> notes;
};

noted_samples read_noted(const std::string& text) {
  noted_samples read;
  const gonio::io::sample_reading reading{.note = [&](const std::string& note) { read.notes.push_back(note); }};
  read.samples = read_samples(text, "arm.csv", reading);
  return read;
}

/// Checks that a text has two samples: 30 and -45 degrees with a reflectance factor of .125, and 0 and 10 with 10.8143.
void check_two_samples(const std::string& text) {
  CAPTURE(text);
  const auto samples = read_samples(text, "arm.csv");
  REQUIRE(samples.size() == 2);
  const auto& [wi, wo] = samples[0].directions.pair();
  CHECK(degrees(gonio::polar_angle(wi)) == doctest::Approx(30.0));
  CHECK(degrees(gonio::polar_angle(wo)) == doctest::Approx(45.0));
  CHECK(wi.x() * wo.x() < 0.0);
  CHECK(samples[0].value.x() * std::numbers::pi == doctest::Approx(0.125));
  CHECK(samples[1].value.x() * std::numbers::pi == doctest::Approx(10.8143));
}

std::string utf16(std::string_view text, bool big) {
  std::string units = big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) units += big ? std::string{'\0', c} : std::string{c, '\0'};
  return units;
}

const std::string german = "theta_i;theta_o;percent\n30;-45;12,5\n0;10;1081,43\n";

}  // namespace

TEST_CASE("rows without a value are left out and counted") {
  for (const std::string word : {"", "NaN", "n/a", "#N/A", "OVER", "OVL", "null", "-", "inf", "---"}) {
    CAPTURE(word);
    const auto [samples, notes] = read_noted("theta_i,phi_i,theta_o,phi_o,r,g,b\n10,0,20,0,1,2,3\n10,0,25,0,1," + word +
                                             ",3\n10,0,30,0,4,5,6\n10,0,-90,0,1,1,1\n10,0,40,0,4,5,6\n");
    CHECK(samples.size() == 3);
    CHECK(samples[1].value.y() == 5.0);
    CHECK(notes == std::vector<std::string>{"arm.csv: 2 of 5 rows are left out: light or viewer is at 90 degrees; no "
                                            "value (line 3: '" +
                                            word + "')"});
  }
  const std::string header = "theta_h,theta_d,phi_d,r,g,b\n";
  CHECK(read_samples(header + "1,2,3,4,5,6\n1,,3,4,5,6\n", "x").size() == 1);
  check_text_refused(header + "1,2,3,4,5,6\n1,2,3,n/a,5,6\n1,2,3,4,5,over\n",
                     {"line 3: column r: 'n/a'", "2 of 3 rows have no value", "at most half"});
  check_text_refused(header + "1,2,3,4,5,6\n1,2,3,five,5,6\n", {"line 3", "'five' is not a number"});
  check_text_refused("theta_i,phi_i,theta_o,phi_o,brdf\n90,0,1,0,1\n90,0,2,0,1\n1,0,1,0,1\n",
                     {"2 of 3 rows are left out", "at most half"});
  // Rows without a value set neither percent signs nor wavelengths.
  CHECK(read_samples("theta_h,theta_d,phi_d,value,wavelength\n1,2,3,n/a,\n1,2,3,5 %,550\n", "x").size() == 1);
  // Directions to be measured have no value yet.
  CHECK(gonio::io::has_directions_alone("theta_i,phi_i,theta_o,phi_o\n1,2,3,4\n", "x", {}));
}

TEST_CASE("a first line sep= sets the separator") {
  check_two_samples("sep=;\n" + german);
  check_two_samples("\"sep=;\"\r\n" + german);
  check_two_samples("SEP=\t\ntheta_i\ttheta_o\tpercent\n30\t-45\t12,5\n0\t10\t1081,43\n");
  check_two_samples("\xEF\xBB\xBFsep=,\ntheta_i,theta_o,percent\n30,-45,12.5\n0,10,1081.43\n");
  check_text_refused("sep=|\n" + german, {"line 1", "'|' is not a separator", "expected sep=, or sep=;"});
  check_text_refused("sep=;\n", {"is empty"});
}

TEST_CASE("lines above the header line are skipped and noted") {
  const auto [samples, notes] = read_noted(
      "Ger\xC3\xA4t;GON-3;;\nProbe;Lack, rot;;\n\n# quantity: percent\nDatum;\"12.11.2026;;\n"
      "theta_i;theta_o;value;temp\n30;-45;12,5;23\n");
  CHECK(samples.size() == 1);
  CHECK(samples[0].value.x() * std::numbers::pi == doctest::Approx(0.125));
  REQUIRE(notes.size() == 3);
  CHECK(notes[0] == "arm.csv: 3 lines above the header line are not read");
  check_two_samples("GON-3 serial 17\n" + german);
  // A file without a header line is refused by its first line.
  check_text_refused("GON-3;serial 17\n1;2\n", {"line 1", "no columns of directions"});
}

TEST_CASE("a line of units below the header line is read") {
  check_two_samples("theta_i;theta_o;Leuchtdichtefaktor\n[\xC2\xB0];deg;%\n30;-45;12,5\n0;10;1081,43\n");
  check_two_samples(
      "theta_i;theta_o;reflectance factor\nrad;rad;-\n0,5235987756;-0,7853981634;0,125\n"
      "0;0,1745329252;10,8143\n");
  check_two_samples(
      "theta_i [deg];theta_o;percent;temp\n;deg;;\xC2\xB0"
      "C\n30;-45;12,5;20\n0;10;1081,43;20\n");
  check_text_refused("theta_i;theta_o;value\ndeg;deg;cd\n30;-45;12,5\n", {"line 1", "'value'"});
}

TEST_CASE("UTF-16, lone carriage returns, and degree and percent signs are read") {
  check_two_samples(utf16(german, false));
  check_two_samples(utf16(german, true));
  check_two_samples(utf16(german, false).substr(2));
  std::string mac = german;
  for (char& c : mac)
    if (c == '\n') c = '\r';
  check_two_samples(mac);
  check_two_samples(
      "# quantity: percent\ntheta_i;theta_o;value\n30\xC2\xB0;-45 \xB0;12,5 %\n0 deg;10\xC2\xB0;1081,43%\n");
  check_text_refused("theta_i;theta_o;brdf\n30;-45;1\xC2\xB0\n", {"line 2", "column value", "is not a number"});
}

TEST_CASE("group marks of thousands are read if they are unambiguous") {
  for (const std::string number : {"1.081,43", "1'081,43",
                                   "1\xC2\xA0"
                                   "081,43",
                                   "1\xE2\x80\xAF"
                                   "081,43",
                                   "1\xE2\x80\x99"
                                   "081,43"})
    check_two_samples("theta_i;theta_o;percent\n30;-45;12,5\n0;10;" + number + "\n");
  check_two_samples("theta_i,theta_o,percent\n30,-45,\"12.5\"\n0,10,\"1,081.43\"\n");
  const auto value_of = [](const std::string& number) {
    return read_samples("theta_h;theta_d;phi_d;r;g;b\n1;2;3;" + number + ";0;0\n", "x")[0].value.x();
  };
  CHECK(value_of("-1.234.567,5") == doctest::Approx(-1234567.5));
  CHECK(value_of("1'234") == 1234.0);
  CHECK(value_of("1,234") == 1.234);  // one mark alone is a decimal mark
  for (const std::string number :
       {"1.23,4", "1.23.456,7", "1.2345,6", "12345.678,9", "1,234,567", "1'23", "'123", "1.234.56"}) {
    CAPTURE(number);
    check_text_refused("theta_h;theta_d;phi_d;r;g;b\n1;2;3;" + number + ";0;0\n", {"column r", "is not a number"});
  }
  check_text_refused("theta_i;theta_o;percent\n30;-45;12,5\n0;10;1,081.43\n", {"line 3", "decimal point"});
}

TEST_CASE("names of columns may be French, German, in Greek letters, or terms of remote sensing") {
  for (const std::string header :
       {"Einfallswinkel [\xC2\xB0];Beobachtungswinkel [\xC2\xB0];Leuchtdichtefaktor [%]",
        "Angle d'incidence (\xC2\xB0);Angle d\xE2\x80\x99observation (\xC2\xB0);Facteur de luminance (%)",
        "Angle incidence (\xB0);Angle observation (\xB0);Facteur de r\xE9"
        "flectance (%)",
        "AOI;AOR;R [%]", "\xCE\xB8i;\xCE\xB8o;percent", "\xCE\xB8_i [\xC2\xB0];\xCF\x91\xE1\xB5\xA3 [\xC2\xB0];R [%]",
        "sza;vza;BRF (%)"})
    check_two_samples(header + "\n30;-45;12,5\n0;10;1081,43\n");
  CHECK(gonio::io::read_samples("theta_h,theta_d,phi_d,Longueur d'onde [nm],BRDF\n1,2,3,633,1\n", "x").channels() ==
        gonio::channels({633.0}));
  check_text_refused("R;theta_i;theta_o\n1;45;-45\n", {"'g' is missing", "--columns value=R"});
}

TEST_CASE("an azimuth relative to the light's is read") {
  for (const std::string name : {"dphi", "raa", "phi", "\xCE\x94\xCF\x86 [\xC2\xB0]", "relative azimuth"}) {
    CAPTURE(name);
    const auto [samples, notes] = read_noted("theta_i,theta_o," + name + ",brdf\n30,30,180,1\n30,40,50,1\n");
    CHECK(samples[0].angles().theta_h < 1e-6);
    CHECK(degrees(gonio::azimuth(samples[1].directions.pair().wo)) == doctest::Approx(50.0));
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find("is read as phi_o - phi_i: 0 degrees on the light's side") != std::string::npos);
  }
  const gonio::io::sample_reading as_mirror{.sign = gonio::io::theta_o_sign::mirror};
  CHECK(read_samples("theta_i,theta_o,raa,brdf\n30,30,0,1\n", "x", as_mirror)[0].angles().theta_h < 1e-6);
  // Beside both azimuths it is ignored, beside one it is refused.
  CHECK(read_samples("sza,vza,saa,vaa,raa,brf\n30,30,10,190,180,1\n", "x")[0].angles().theta_h < 1e-6);
  check_text_refused("theta_i,theta_o,phi_i,dphi,brdf\n30,30,10,180,1\n", {"line 1", "'dphi'", "expected one of them"});
}
