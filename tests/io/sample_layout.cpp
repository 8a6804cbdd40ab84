// Matrices, angles stated above the header line, and tristimulus values.

#include "sample_text.hpp"
#include <gonio/core/rgb.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <numbers>
#include <string>
#include <vector>

using gonio::degrees;
using gonio::io::read_samples;
using scratch::check_refused;
using scratch::check_text_refused;

namespace {

using notes = std::vector<std::string>;

gonio::sample_set read_noted(const std::string& text, notes& said) {
  return read_samples(text, "arm.csv", {.note = [&](const std::string& note) { said.push_back(note); }});
}

/// Polar angles of light and viewer, degrees, positive on the light's side.
std::vector<double> signed_angles(const gonio::sample& sample) {
  const auto& [wi, wo] = sample.directions.pair();
  const auto angle = [](const gonio::direction& w) {
    return std::round(1e6 * degrees(std::copysign(gonio::polar_angle(w), w.x()))) / 1e6;
  };
  return {angle(wi), angle(wo)};
}

using angles = std::vector<double>;

const std::string percent = "# quantity: percent\n";
const std::string down_and_across = percent + "theta_o;0\xC2\xB0;30\xC2\xB0\n45;12,5;25\n-45;;50\n-30;100;\n";

}  // namespace

TEST_CASE("a matrix has the viewer's angle down and the light's across") {
  notes said;
  const auto samples = read_noted(down_and_across, said);
  REQUIRE(samples.size() == 4);
  CHECK(signed_angles(samples[0]) == angles{0.0, 45.0});
  CHECK(signed_angles(samples[1]) == angles{30.0, 45.0});
  CHECK(signed_angles(samples[2]) == angles{30.0, -45.0});
  CHECK(signed_angles(samples[3]) == angles{0.0, -30.0});
  for (int i = 0; i < 4; ++i)
    CHECK(samples[i].value.y() * std::numbers::pi == doctest::Approx(std::vector{0.125, 0.25, 0.5, 1.0}[i]));
  REQUIRE(said.size() == 3);
  CHECK(said[0] == "arm.csv: is read as a matrix, theta_o down, theta_i across: 0, 30 degrees");
  CHECK(said[2] == "arm.csv: 2 of 6 cells are left out: no value (line 4: '')");
}

TEST_CASE("a matrix has the light's angle down if its first field names it") {
  for (const std::string corner : {"theta_i", "AOI [deg]", "theta_i \\ theta_o", "Einfallswinkel|Beobachtungswinkel"}) {
    CAPTURE(corner);
    const auto samples = read_samples(percent + corner + "\t-10\t22.5\n30\t1\t2\n", "arm.csv");
    REQUIRE(samples.size() == 2);
    CHECK(signed_angles(samples[0]) == angles{30.0, -10.0});
    CHECK(signed_angles(samples[1]) == angles{30.0, 22.5});
  }
  for (const std::string across : {"theta_i=10;theta_i=22,5", "AOI 10 deg;AOI 22,5 deg", "10 \xB0;22,5\xB0"}) {
    CAPTURE(across);
    const auto samples = read_samples(percent + "Winkel;" + across + "\n-30;1;2\n", "arm.csv",
                                      {.columns = {{"theta_o", "Winkel"}}, .quantity = {}, .note = {}});
    REQUIRE(samples.size() == 2);
    CHECK(signed_angles(samples[1]) == angles{22.5, -30.0});
  }
}

TEST_CASE("a matrix may have a preamble, a line of units and a sign of theta_o") {
  const std::string text = "Scatterometer;7;\n\nRun;2;\ntheta_o;0;30\ndeg;%;%\n40;12,5;25\n";
  notes said;
  const auto samples = read_samples(text, "arm.csv",
                                    {.columns = {},
                                     .quantity = {},
                                     .note = [&](const std::string& note) { said.push_back(note); },
                                     .sign = gonio::io::theta_o_sign::mirror});
  REQUIRE(samples.size() == 2);
  CHECK(signed_angles(samples[0]) == angles{0.0, -40.0});
  CHECK(signed_angles(samples[1]) == angles{30.0, -40.0});
  CHECK(samples[1].value.x() * std::numbers::pi == doctest::Approx(0.25));
  REQUIRE(said.size() == 2);
  CHECK(said[0] == "arm.csv: 2 lines above the header line are not read");
  CHECK(read_samples(percent + "theta_o,0,30\n40,12.5 %,25 %\n-40,1 %,2%\n", "x").size() == 4);
  CHECK(read_samples(percent + "Einfallswinkel: 30\ntheta_o;0;30\n-40;1;2\n", "x").size() == 2);
  // A matrix has values even if its first cell is empty.
  CHECK_FALSE(gonio::io::has_directions_alone(percent + "theta_o;0;30\n-40;;2\n-45;1;2\n", "x"));
}

TEST_CASE("bad matrices and matrices of unknown sides are refused") {
  check_text_refused("theta_o;0;30\n45;1;2\n-45;1;2\n", {"line 2", "does not state the quantity of value"});
  check_text_refused(percent + "theta_o;0;30\n45;1;2\n40;1;2\n", {"line 3", "side of the normal is unknown"});
  check_text_refused(percent + "theta_o;0;95\n-45;1;2\n", {"line 2", "'theta_i' is missing", "'95'"});
  check_text_refused(percent + "theta_o [rad];0;30\n-0,5;1;2\n", {"line 2", "'theta_i' is missing"});
  check_text_refused(percent + "theta_o;0;phi=30\n-45;1;2\n", {"line 2", "'phi=30'"});
  check_text_refused(percent + "theta_o;theta_o=10\n-45;1;2\n", {"line 2", "'theta_o=10'"});
  check_text_refused(percent + "theta_o \\ phi_i;0;30\n-45;1;2\n", {"line 2", "no columns of directions"});
  check_text_refused(percent + ";0;30\n-45;1;2\n", {"line 2"});
  check_text_refused(percent + "theta_o;0;30\n-45;1;two\n", {"line 3", "'two'"});
  check_text_refused(percent + "theta_o;0;30\n-45;1;2;3\n", {"line 3", "4 fields, expected 3"});
  check_text_refused(percent + "theta_o;0;30\n-45;1;\n45;;\n",
                     {"line 3", "3 of 4 cells have no value", "at most half"});
  check_text_refused(percent + "theta_o;0;30\n-45;n/a;\n", {"2 of 2 cells have no value"});
}

TEST_CASE("an angle stated above the header line applies to all samples") {
  const std::string table = "theta_o;400nm;500nm\n-45;1;2\n45;3;4\n";
  for (const std::string above :
       {"# theta_i: 30\n", "Messung;7\nEinfallswinkel: 30\xC2\xB0\n", "theta_i;30;\n", "Theta_i [deg] = 30,0;\n"}) {
    CAPTURE(above);
    notes said;
    const auto samples = read_noted(percent + above + table, said);
    REQUIRE(samples.size() == 2);
    CHECK(signed_angles(samples.in_three_channels()[0]) == angles{30.0, -45.0});
    CHECK(samples.values(1)[0] * std::numbers::pi == doctest::Approx(0.03));
    CHECK(std::ranges::find(said, "arm.csv: theta_i is taken to be 30 degrees, as stated above the header line") !=
          said.end());
  }
  // Blocks of one angle of incidence each.
  notes of_blocks;
  const auto blocks = read_noted(
      percent + "# theta_i: 45\ntheta_o;value\n0;1\n-45;9\n# theta_i: 30\n0;1\n-30;8\n# operator: me\n-20;1\n",
      of_blocks);
  REQUIRE(blocks.size() == 5);
  CHECK(signed_angles(blocks[1]) == angles{45.0, -45.0});
  CHECK(signed_angles(blocks[3]) == angles{30.0, -30.0});
  CHECK(signed_angles(blocks[4]) == angles{30.0, -20.0});
  CHECK(std::ranges::find(of_blocks,
                          "arm.csv: theta_i is taken to be 45 degrees, as stated above the header line, and "
                          "below it as stated above each block of samples") != of_blocks.end());
  check_text_refused(percent + "# theta_i: 45\n# theta_i: 30\n" + table, {"theta_i", "twice", "45 and 30", "once"});
  const auto hemisphere = read_samples(percent + "# theta_i: 30\n# phi_i: 90\ntheta_o;phi_o;value\n45;270;1\n", "x");
  CHECK(hemisphere[0].angles().theta_d == doctest::Approx(gonio::radians(37.5)));
  // A column overrides the stated angle.
  CHECK(signed_angles(read_samples(percent + "# theta_i: 30\ntheta_i;theta_o;value\n20;-45;1\n", "x")[0]) ==
        angles{20.0, -45.0});
  check_text_refused(percent + table, {"line 2", "'theta_i' is missing"});
  check_text_refused(percent + "# theta_i: oblique\n" + table, {"line 3", "'theta_i' is missing"});
  check_text_refused(percent + table + "# theta_i: 30\n", {"'theta_i' is missing"});
  check_text_refused(percent + "# theta_i: 95\n" + table, {"line 4", "theta_i: 95 degrees"});
}

TEST_CASE("X, Y and Z are tristimulus values under D65, of a stated quantity") {
  const std::string rows = "theta_i;theta_o;X;Y;Z\n30;-30;19,56;11,87;3,97\n";
  notes said;
  const auto samples = read_noted(percent + rows, said);
  const gonio::rgb expected = gonio::from_xyz({0.1956, 0.1187, 0.0397}) / std::numbers::pi;
  REQUIRE(samples.size() == 1);
  CHECK(samples.channels().are_colours());
  for (int c = 0; c < 3; ++c) CHECK(samples[0].value[c] == doctest::Approx(expected[c]));
  CHECK(gonio::luminance(samples[0].value) * std::numbers::pi == doctest::Approx(0.1187).epsilon(1e-3));
  REQUIRE(said.size() == 2);
  CHECK(said[0] == "arm.csv: X, Y and Z are read as CIE tristimulus values under D65");
  const auto brdf = read_samples("# quantity: brdf\ntheta_i,theta_o,CIE X,CIE Y,CIE Z [1/sr]\n30,-30,1,2,3\n", "x");
  CHECK(brdf[0].value.y() == doctest::Approx(gonio::from_xyz({1.0, 2.0, 3.0}).y()));
  CHECK(read_samples("theta_i,theta_o,X [%],Y [%],Z [%]\n30,-30,95,100,109\n", "x")[0].value.x() ==
        doctest::Approx(1.0 / std::numbers::pi).epsilon(0.01));
}

TEST_CASE("an evident scale of X, Y and Z is assumed and noted, an unclear one is refused") {
  const auto read = [](const std::string& rows, notes& said) {
    return read_noted("theta_i;theta_o;X;Y;Z\n" + rows, said);
  };
  notes said;
  const auto percents = read("30;-30;90;400;100\n30;0;9;10;10\n30;10;9;10;10\n", said);
  CHECK(gonio::luminance(percents[1].value) * std::numbers::pi == doctest::Approx(0.1).epsilon(1e-3));
  REQUIRE(said.size() == 3);
  CHECK(said[0] ==
        "arm.csv: a perfect diffuser is taken to have Y 100, as the largest Y is 400, the median 10 (--quantity "
        "reflectance-factor: Y 1)");
  said.clear();
  const auto factors = read("30;-30;0,9;1;1\n30;0;0,09;0,1;0,1\n", said);
  CHECK(gonio::luminance(factors[1].value) * std::numbers::pi == doctest::Approx(0.1).epsilon(1e-3));
  CHECK(said[0].find("Y 1, as the largest Y is 1, the median 0.55 (--quantity percent: Y 100)") != std::string::npos);
  check_refused([&] { return read("30;-30;9;4;1\n30;0;.1;.1;.1\n30;5;.1;.1;.1\n", said); },
                {"the largest Y is 4, the median 0.1", "--quantity reflectance-factor if", "--quantity percent if"});
}

TEST_CASE("X, Y and Z are ignored beside other values, in lower case, or if one is missing") {
  CHECK(read_samples("theta_i,theta_o,r,g,b,X,Y,Z\n30,-30,1,2,3,4,5,6\n", "x")[0].value.z() == 3.0);
  CHECK(read_samples("theta_i,theta_o,brdf,x,y,z\n30,-30,1,4,5,6\n", "x")[0].value.z() == 1.0);
  const auto beside = read_samples("x,y,theta_i,theta_o,X [%],Y [%],Z [%]\n.3,.3,30,-30,95,100,109\n", "x");
  CHECK(gonio::luminance(beside[0].value) * std::numbers::pi == doctest::Approx(1.0).epsilon(1e-3));
  check_text_refused("theta_i,theta_o,Y,x,y\n30,-30,1,.3,.3\n", {"line 1", "column 'r' is missing"});
  check_text_refused(percent + "theta_i,theta_o,X,Y,Z,wavelength\n30,-30,1,1,1,5\n",
                     {"X,Y,Z cannot have a wavelength"});
  check_text_refused(percent + "theta_i,theta_o,X,Y,Z\n30,-30,1e41,1,1\n", {"line 3", "X", "range of float"});
  check_text_refused(percent + "theta_i,theta_o,X,Y,Z\n30,-30,1,bright,1\n", {"line 3", "column Y", "'bright'"});
}

TEST_CASE("any text of a matrix or of X, Y and Z is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-=;\n# XYZ")));
    for (const std::string start : {"theta_o;0;30", "# theta_i: 3\ntheta_o;X;Y;Z", "theta_i"}) try {
        for (const gonio::sample& s : read_samples(percent + start + text, "x").in_three_channels())
          RC_ASSERT(s.value.isFinite().all());
      } catch (const gonio::error&) {
      }
  }));
}
