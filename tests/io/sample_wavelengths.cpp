#include "scratch.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

using gonio::io::read_sample_file;
using scratch::check_refused;

namespace {

const std::string angles = "theta_i,phi_i,theta_o,phi_o,", at = "30,0,40,180,";

void check_text_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_sample_file(text, "paint.csv"); }, {"paint.csv"});
  check_refused([&] { return read_sample_file(text, "paint.csv"); }, words);
}

}  // namespace

TEST_CASE("columns named by wavelengths are spectra, in every notation of instruments") {
  const std::vector<double> expected{400.0, 410.5, 700.0};
  for (const std::string columns :
       {"400nm,410.5nm,700nm", "400,410.5,700", "400 nm,410.5 nm,700 nm", "400 [nm],410.5 [nm],700 [nm]",
        "w400,w410.5,w700", "lambda_400,lambda_410.5,lambda_700", "400_nm,410.5_NM,700 (nm)", "WL400,wl410.5,700nm"}) {
    CAPTURE(columns);
    const std::string text = "# quantity: brdf\n" + angles + columns + "\n" + at + ".1,.2,-.3\n" + at + "1,2,3\n";
    const auto file = read_sample_file(text, "x");
    CHECK(file.samples.channels().wavelengths() == expected);
    REQUIRE(file.samples.size() == 2);
    CHECK(file.samples.values(0)[2] == -0.3);
    CHECK(file.samples.values(1)[1] == 2.0);
    CHECK(file.samples.weight(1) == gonio::channel_weights(1.0));
    CHECK(file.samples.directions(0).pair().wi.z() == doctest::Approx(std::cos(gonio::radians(30))));
  }
}

TEST_CASE("explicit wavelengths may have any value") {
  for (const std::string columns :
       {"13.5nm,25000nm", "13.5 [nm],25000 [nm]", "w13.5,w25000", "lambda_13.5,lambda_25000"}) {
    CAPTURE(columns);
    const auto file = read_sample_file("# quantity: brdf\n" + angles + columns + "\n" + at + ".1,.2\n", "x");
    CHECK(file.samples.channels().wavelengths() == std::vector<double>{13.5, 25000.0});
  }
}

TEST_CASE("spectra may have any quantity and dialect, weights and other columns") {
  const auto file = read_sample_file(
      "# instrument: arm\n# quantity: "
      "percent\ntheta_i;theta_o;phi_i;phi_o;weight;500nm;600nm\n10;20;0;90;0,5;31,4;100\n",
      "x");
  CHECK(file.samples.values(0)[0] == doctest::Approx(0.314 * std::numbers::inv_pi));
  CHECK(file.samples.values(0)[1] == doctest::Approx(std::numbers::inv_pi));
  CHECK(file.samples.weight(0) == gonio::channel_weights(0.5));
  CHECK(file.quantity == gonio::io::sample_quantity::percent);
  const std::string commas = "# quantity: brdf\ntheta_h;theta_d;phi_d;632,8 nm\n10;20;30;0,5\n";
  CHECK(read_sample_file(commas, "x").samples.channels() == gonio::channels({632.8}));
  CHECK(file.provenance.instrument == "arm");
}

TEST_CASE("one wavelength is one channel") {
  const std::string laser = "# quantity: brdf\n" + angles + "633nm\n" + at + "0.25\n";
  const auto file = read_sample_file(laser, "x");
  CHECK(file.samples.channels() == gonio::channels({633.0}));
  CHECK((file.samples.front().value == 0.25).all());
  const std::string beside = "# quantity: brdf\n" + angles + "wavelength,value\n" + at + "633,0.25\n";
  CHECK(read_sample_file(beside, "x").samples.channels() == file.samples.channels());
  const std::string unnamed = "# quantity: brdf\n" + angles + "value\n" + at + "0.25\n";
  CHECK(read_sample_file(unnamed, "x").samples.channels() == gonio::channels::one_value());
}

TEST_CASE("bad spectra are refused") {
  const std::string brdf = "# quantity: brdf\n";
  check_text_refused(brdf + angles + "500nm,400nm\n" + at + "1,2\n", {"line 2", "'400nm'", "500 nm", "ascend"});
  check_text_refused(brdf + angles + "400nm,400\n" + at + "1,2\n", {"line 2", "'400'", "without repeats"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1\n", {"line 3", "5 fields, expected 6"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,2\n" + at + "1,2,3\n", {"line 4", "7 fields"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,nan\n", {"line 3", "column 500nm", "'nan'"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,1e39\n", {"line 3", "column 500nm", "range of float"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,\n", {"line 3", "column 500nm"});
  check_text_refused(angles + "400nm,500nm\n" + at + "1,2\n", {"the quantity of 400nm", "# quantity: brdf"});
  check_text_refused(brdf + angles + "r,g,b,400nm\n" + at + "1,2,3,4\n", {"two ways", "400nm"});
  check_text_refused(brdf + angles + "value,400nm\n" + at + "1,2\n", {"two ways", "400nm"});
  check_text_refused(brdf + angles + "400nm,wavelength\n" + at + "1,400\n", {"wavelength", "400nm"});
  check_text_refused(brdf + angles + "400nm,500nm,weight_r,weight_g,weight_b\n" + at + "1,2,1,1,1\n", {"one weight"});
  check_text_refused(brdf + angles + "400nm,500nm\n", {"no samples"});
  // Small numbers are not wavelengths: such columns are ignored.
  check_text_refused(brdf + angles + "1,2\n" + at + "1,2\n", {"'r' is missing", "as 400nm"});
}

TEST_CASE("directions are read from files of spectra") {
  const scratch::folder here;
  const auto path = here / "spectra.csv";
  scratch::put(path, angles + "400nm,500nm\n" + at + "1,2\n");
  CHECK(gonio::io::read_directions(path).size() == 1);
}

TEST_CASE("spectra are read back bit for bit") {
  const scratch::folder here;
  const gonio::channels bands({400.0, 632.8, 1064.0});
  gonio::sample_set samples(bands);
  samples.add({0.2, 0.1, 1.0}, std::array{0.1, 1e-7, -3.0}, 1.0);
  samples.add({0.2, 0.7, 1.0}, std::array{0.2, 4.0, 1e30}, 0.25);
  samples.add({0.2, 1.1, 1.0}, std::array{5.0, 6.0, 7.0}, 0.0);
  for (const gonio::sample_set& some : {samples, samples.channel(1)}) {
    const auto path = here / "spectra.csv";
    gonio::io::write_samples(path, some, {"arm", "", ""});
    const auto read = read_sample_file(path);
    CHECK(read.samples.channels() == some.channels());
    CHECK(read.provenance.instrument == "arm");
    REQUIRE(read.samples.size() == 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
      CHECK(std::ranges::equal(read.samples.values(i), some.values(i)));
      CHECK(read.samples.weight(i) == some.weight(i));
      const double theta_d = some.directions(i).angles().theta_d;
      CHECK(read.samples.directions(i).angles().theta_d == doctest::Approx(theta_d).epsilon(1e-12));
    }
  }
  const gonio::sample_set value = gonio::sample_set{{{0.2, 0.1, 1.0}, gonio::rgb(1, 2, 3)}}.channel(2);
  CHECK(gonio::io::write_samples(value).find("phi_d,value,weight\n") != std::string::npos);
  CHECK(gonio::io::read_samples(gonio::io::write_samples(value), "x").channels() == gonio::channels::one_value());
}

TEST_CASE("any text of spectra is read or refused") {
  CHECK(rc::check([&] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-+e,;\n#nmw")));
    try {
      const auto file = read_sample_file("# quantity: brdf\n" + angles + text, "x");
      gonio::require_usable(file.samples);
    } catch (const gonio::error&) {
    }
  }));
}
