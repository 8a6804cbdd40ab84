#include "sample_text.hpp"
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <string>

using gonio::degrees;
using gonio::io::read_samples;
using scratch::check_refused;
using scratch::check_text_refused;

namespace {

const std::string half_header = "theta_h,theta_d,phi_d,r,g,b\n";

}  // namespace

TEST_CASE("every dialect gives the same samples") {
  const auto expected = read_samples(
      "theta_i,phi_i,theta_o,phi_o,r,g,b,weight\n30.5,0,45,180.25,0.1,-0.2,3e-1,1\n10,20,60,90,1,2,3,0.5\n", "x");
  for (const std::string text :
       {// spreadsheets of countries with decimal commas
        "theta_i;phi_i;theta_o;phi_o;r;g;b;weight\n30,5;0;45;180,25;0,1;-0,2;3e-1;1\n10;20;60;90;1;2;3;0,5\n",
        "theta_i\tphi_i\ttheta_o\tphi_o\tr\tg\tb\tweight\n30,5\t0\t45\t180,25\t0,1\t-0,2\t3e-1\t1\n"
        "10\t20\t60\t90\t1\t2\t3\t0,5\n",
        // semicolons and tabs with decimal points
        "theta_i;phi_i;theta_o;phi_o;r;g;b;weight\n30.5;0;45;180.25;0.1;-0.2;3e-1;1\n10;20;60;90;1;2;3;0.5\n",
        "theta_i\tphi_i\ttheta_o\tphi_o\tr\tg\tb\tweight\r\n30.5\t0\t45\t180.25\t0.1\t-0.2\t3e-1\t1\r\n"
        "10\t20\t60\t90\t1\t2\t3\t0.5\r\n",
        // runs of blanks
        "  theta_i phi_i  theta_o phi_o r g b weight\n 30.5  0 45 180.25   0.1 -0.2\t3e-1 1\n10 20 60 90 1 2 3 .5 \n",
        "theta_i phi_i theta_o phi_o r g b weight\n30,5 0 45 180,25 0,1 -0,2 3e-1 1\n10 20 60 90 1 2 3 0,5\n",
        // quotes, also around decimal commas
        "\"theta_i\",\"phi_i\",\"theta_o\",\"phi_o\",\"r\",\"g\",\"b\",\"weight\"\r\n"
        "\"30,5\",0,45,\"180,25\",\"0,1\", \"-0,2\" ,3e-1,1\r\n10,20,60,90,1,2,3,\"0,5\"\r\n",
        "theta_i \"phi_i\" theta_o phi_o r g b weight\n\"30.5\" 0 45 180.25 0.1 -0.2 3e-1 \"1\" \n10 20 60 90 1 2 3 "
        ".5\n",
        // names in any case, with units, and synonyms
        "\xEF\xBB\xBFTheta In;PHI_IN;Theta Out [deg];phi_s (\xC2\xB0);Red;GREEN;b [1/sr];Weight\n"
        "30,5;0;45;180,25;0,1;-0,2;3e-1;1\n10;20;60;90;1;2;3;0,5\n",
        "thetai,phii,theta_r_deg,phi_r/deg,R,G,B "
        "[sr^-1],weight\n30.5,0,45,180.25,0.1,-0.2,3e-1,1\n10,20,60,90,1,2,3,.5\n",
        // comments, empty lines and short header lines as spreadsheets write them
        "\"# measured, on a Thursday\";;;;;;;\ntheta_i;phi_i;theta_o;phi_o;r;g;b;weight;;\n;;;;;;;;;\n"
        "30,5;0;45;180,25;0,1;-0,2;3e-1;1;;\n10;20;60;90;1;2;3;0,5\n",
        // other columns, of text with quotes
        "number,theta_i,phi_i,theta_o,phi_o,r,g,b,weight,remark\n1,30.5,0,45,180.25,0.1,-0.2,3e-1,1,\"a \"\"b\"\", "
        "c\"\n"
        "2,10,20,60,90,1,2,3,0.5,\n",
        "theta_i\tphi_i\ttheta_o\tphi_o\tr\tg\tb\tweight\tremark\n30.5\t0\t45\t180.25\t0.1\t-0.2\t3e-1\t1\t\n"
        "10\t20\t60\t90\t1\t2\t3\t0.5\tsecond\n"}) {
    CAPTURE(text);
    const auto samples = read_samples(text, "x");
    REQUIRE(samples.size() == expected.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      CHECK((samples[i].value == expected[i].value).all());
      CHECK(samples[i].weight == expected[i].weight);
      CHECK(samples[i].directions.pair().wi == expected[i].directions.pair().wi);
      CHECK(samples[i].directions.pair().wo == expected[i].directions.pair().wo);
    }
  }
}

TEST_CASE("without azimuths, the signs of polar angles give the sides of the normal") {
  const auto samples = read_samples("theta_i,theta_o,value\n# quantity: brdf\n45,-45,2\n45,20,1\n", "x");
  CHECK(samples[0].angles().theta_h == doctest::Approx(0.0));  // the mirror direction
  CHECK(degrees(samples[1].angles().theta_d) == doctest::Approx(12.5));
  CHECK(read_samples("theta_i,theta_o,r,g,b\n0,45,1,1,1\n30,0,1,1,1\n", "x").size() == 2);  // no sides to tell apart
  check_text_refused("theta_i,theta_o,r,g,b\n0,45,1,1,1\n45,20,1,1,1\n45,45,1,1,1\n",
                     {"line 3", "side of the normal is unknown", "phi_i and phi_o"});
  check_text_refused("theta_i,theta_o,phi_0,r,g,b\n45,-45,0,1,1,1\n", {"'phi_i' is missing", "perhaps it is 'phi_0'"});
  check_text_refused("theta_i,theta_o,azimuth,r,g,b\n45,-45,0,1,1,1\n", {"'phi_i' is missing", "'azimuth'"});
  check_text_refused("theta_i,r,g,b\n45,1,1,1\n", {"'theta_o' is missing"});
}

TEST_CASE("one wavelength and the file's provenance are read") {
  const auto file = gonio::io::read_sample_file(
      "# Instrument: GON 360: arm 2\n#date:2026-11-25\n# conditions: 23 C\n# conditions: dry\n# other: x\n"
      "theta_i,phi_i,theta_o,phi_o,wavelength [nm],BRDF [1/sr]\n10,0,60,0,633,0.25\n10,0,50,0,633,0.5\n",
      "x");
  CHECK(file.samples.channels() == gonio::channels({633.0}));
  CHECK(file.quantity == gonio::io::sample_quantity::brdf);
  CHECK(file.provenance == gonio::io::sample_provenance{"GON 360: arm 2", "2026-11-25", "23 C; dry"});
  CHECK((file.samples[1].value == 0.5).all());
  CHECK(gonio::io::write_samples(file.samples, file.provenance)
            .starts_with("# instrument: GON 360: arm 2\n# date: 2026-11-25\n# conditions: 23 C; dry\n# quantity: "
                         "brdf\ntheta_h,theta_d,phi_d,633nm,weight\n"));
  const std::string two = "theta_h,theta_d,phi_d,wavelength,brdf\n1,2,3,550,1\n1,2,3,";
  check_text_refused(two + "650,1\n", {"line 3", "650 nm, but 550 nm above", "more than one wavelength"});
  check_text_refused(two + "0,1\n", {"line 3", "wavelength: 0 nm", "more than 0"});
  check_text_refused("theta_h,theta_d,phi_d,wavelength,r,g,b\n1,2,3,550,1,1,1\n", {"r,g,b cannot have a wavelength"});
}

TEST_CASE("a number sign in quotes begins a comment only above the header line") {
  const auto samples = read_samples(
      "\"# measured\";;\n\"#\";theta_h;theta_d;phi_d;brdf\n\"#1\";1;2;3;4\n\"# 2\";1;2;3;5\n#3;1;2;3;6\n", "x");
  REQUIRE(samples.size() == 2);
  CHECK(samples[1].value[0] == 5.0);
}

TEST_CASE("errors describe the file's dialect") {
  check_text_refused("theta_i;phi_i;tetha_o;phi_o;r;g;b\n1;2;3;4;5;6;7\n",
                     {"line 1", "'theta_o' is missing: perhaps it is 'tetha_o'", "looks semicolon-separated"});
  check_text_refused("Einfall;Ausfall;Y\n1;2;3\n",
                     {"no columns of directions", "looks semicolon-separated", "'Einfall', 'Ausfall', 'Y'"});
  check_text_refused(half_header + "1;2;3;4;5;6\n",
                     {"1 field, expected 6", "looks comma-separated, this one semicolon"});
  check_text_refused(half_header + "1,5,2,3,4,5,6,5\n",
                     {"8 fields, expected 6", "semicolons if numbers have decimal commas"});
  check_text_refused("theta_h;theta_d;phi_d;r;g;b\n1,5;2;3;4;5;6\n1;2;3;4.5;5;6\n",
                     {"line 3", "column r", "'4.5' has a decimal point, but a number above has a decimal comma",
                      "looks semicolon-separated with decimal commas"});
  check_text_refused("theta_h;theta_d;phi_d;r;g;b\n1;2;3;1.23,5;5;6\n", {"'1.23,5'", "a point and a comma"});
  check_text_refused("theta_h\ttheta_d\tphi_d\tr\tg\tb\n1\t2\t3\tn/a\t5\t6\n", {"'n/a'", "looks tab-separated"});
  check_text_refused("theta_i,theta_in,phi_i,phi_o,theta_o,r,g,b\n", {"'theta_in', which is theta_i, appears twice"});
  check_text_refused("theta_h,theta_d,phi_d,R\n1,2,3,4\n", {"'g' is missing", "value for one channel"});
  check_text_refused("\"theta_h,theta_d,phi_d,r,g,b\n", {"line 1", "double quote is not closed"});
  check_text_refused(half_header + "1,2,\"3\"0,4,5,6\n", {"line 2", "after its closing double quote"});
  check_text_refused(std::string("PK\x03\x04\x14\x00", 6), {"workbook", "CSV"});
  check_text_refused(std::string("\xFF\xFEt\x00h\x00", 6), {"line 1", "no columns of directions", "'th'"});
}

TEST_CASE("without azimuths, the sign of theta_o is stated, or checked by brightness") {
  const auto scan = [](double towards_light, double mirror) {
    return "theta_i,theta_o,r,g,b\n30,28," + std::to_string(towards_light) + ",1,1\n30,0,1,1,1\n30,-31," +
           std::to_string(mirror) + ",1,1\n";
  };
  const auto side_of_first = [](const std::string& text, const gonio::io::sample_reading& reading = {}) {
    return gonio::io::read_samples(text, "x", reading)[0].directions.pair().wo.x() > 0.0 ? "light" : "mirror";
  };
  const gonio::io::sample_reading as_mirror{.sign = gonio::io::theta_o_sign::mirror},
      as_light{.sign = gonio::io::theta_o_sign::light};
  CHECK(side_of_first(scan(1.0, 30.0)) == std::string("light"));
  CHECK(side_of_first(scan(1.9, 1.0)) == std::string("light"));  // rough surfaces are brighter towards the light
  check_text_refused(scan(30.0, 0.0), {"theta_o = theta_i", "times as bright", "--theta-o-sign mirror"});
  check_text_refused(scan(30.0, 1.0), {"30 times as bright"});
  CHECK(side_of_first(scan(30.0, 1.0), as_mirror) == std::string("mirror"));
  CHECK(side_of_first(scan(30.0, 1.0), as_light) == std::string("light"));
  CHECK(side_of_first("# theta-o-sign: mirror\n" + scan(30.0, 1.0)) == std::string("mirror"));
  // No reading has the receiver in front of the lamp.
  check_text_refused("theta_i,theta_o,r,g,b\n30,31,30,1,1\n30,-60,1,1,1\n", {"30 times as bright"});
  // If all readings are on one side, only a stated sign gives the side.
  CHECK(side_of_first("theta_i,theta_o,r,g,b\n30,31,1,1,1\n", as_mirror) == std::string("mirror"));
  check_text_refused("# theta-o-sign: left\n" + scan(1.0, 1.0), {"line 1", "'left'", "light or mirror"});
  check_refused([&] { return gonio::io::read_samples("# theta-o-sign: light\n" + scan(1.0, 1.0), "x", as_mirror); },
                {"theta-o-sign light", "contradicts it"});
  check_refused(
      [&] { return gonio::io::read_samples("theta_h,theta_d,phi_d,r,g,b\n1,2,3,1,1,1\n", "paint.csv", as_light); },
      {"paint.csv", "to which theta-o-sign does not apply"});
}

TEST_CASE("azimuths are counted from the mirror direction if theta-o-sign is mirror") {
  const std::string rows = "theta_i,phi_i,theta_o,phi_o,r,g,b\n30,10,30,10,1,1,1\n20,0,40,50,1,1,1\n";
  const gonio::io::sample_reading as_mirror{.sign = gonio::io::theta_o_sign::mirror};
  const auto check_turned = [](const gonio::io::sample_file& file) {
    CHECK(file.sign == gonio::io::theta_o_sign::mirror);
    CHECK(file.samples[0].angles().theta_h < 1e-6);
    CHECK(gonio::degrees(gonio::azimuth(file.samples[1].directions.pair().wo)) == doctest::Approx(-130.0));
  };
  check_turned(gonio::io::read_sample_file(rows, "x", as_mirror));
  check_turned(gonio::io::read_sample_file("# theta-o-sign: mirror\n" + rows, "x", {}));
  CHECK(gonio::io::read_samples(rows, "x")[0].angles().theta_d < 1e-6);
}
