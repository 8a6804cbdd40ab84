#include "scratch.hpp"
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/spectral_samples.hpp>

#include <rapidcheck.h>

#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

using gonio::io::names_wavelengths;
using gonio::io::read_spectral_sample_file;
using scratch::check_refused;

namespace {

const std::string angles = "theta_i,phi_i,theta_o,phi_o,", at = "30,0,40,180,";

void check_text_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_spectral_sample_file(text, "paint.csv"); }, {"paint.csv"});
  check_refused([&] { return read_spectral_sample_file(text, "paint.csv"); }, words);
}

}  // namespace

TEST_CASE("columns called by their wavelengths are spectra, however instruments write them") {
  const std::vector<double> expected{400.0, 410.5, 700.0};
  for (const std::string columns :
       {"400nm,410.5nm,700nm", "400,410.5,700", "400 nm,410.5 nm,700 nm", "400 [nm],410.5 [nm],700 [nm]",
        "w400,w410.5,w700", "lambda_400,lambda_410.5,lambda_700", "400_nm,410.5_NM,700 (nm)", "WL400,wl410.5,700nm"}) {
    CAPTURE(columns);
    const std::string text = "# quantity: brdf\n" + angles + columns + "\n" + at + ".1,.2,-.3\n" + at + "1,2,3\n";
    CHECK(names_wavelengths(text, "x"));
    const auto file = read_spectral_sample_file(text, "x");
    CHECK(file.samples.wavelengths == expected);
    REQUIRE(file.samples.size() == 2);
    CHECK(file.samples.values(0, 2) == -0.3f);
    CHECK(file.samples.values(1, 1) == 2.0f);
    CHECK(file.samples.weights == std::vector<double>{1.0, 1.0});
    CHECK(file.samples.directions[0].pair().wi.z() == doctest::Approx(std::cos(gonio::radians(30))));
  }
}

TEST_CASE("spectra may be stated in any quantity, in any dialect, with weights and other columns among them") {
  const auto file = read_spectral_sample_file(
      "# instrument: arm\n# quantity: "
      "percent\ntheta_i;theta_o;phi_i;phi_o;weight;500nm;600nm\n10;20;0;90;0,5;31,4;100\n",
      "x");
  CHECK(double{file.samples.values(0, 0)} == doctest::Approx(0.314 * std::numbers::inv_pi));
  CHECK(double{file.samples.values(0, 1)} == doctest::Approx(std::numbers::inv_pi));
  CHECK(file.samples.weight(0) == 0.5);
  CHECK(file.quantity == gonio::io::sample_quantity::percent);
  const std::string commas = "# quantity: brdf\ntheta_h;theta_d;phi_d;632,8 nm\n10;20;30;0,5\n";
  CHECK(read_spectral_sample_file(commas, "x").samples.wavelengths == std::vector<double>{632.8});
  CHECK(file.provenance.instrument == "arm");
}

TEST_CASE("one wavelength is one channel, as it is") {
  const std::string laser = "# quantity: brdf\n" + angles + "633nm\n" + at + "0.25\n";
  CHECK_FALSE(names_wavelengths(laser, "x"));
  const auto file = read_spectral_sample_file(laser, "x");
  CHECK(file.samples.wavelengths == std::vector<double>{633.0});
  const auto grey = gonio::io::read_sample_file(laser, "x");
  CHECK(grey.wavelength == 633.0);
  CHECK((grey.samples.front().value == 0.25).all());
  const std::string beside = "# quantity: brdf\n" + angles + "wavelength,value\n" + at + "633,0.25\n";
  CHECK(read_spectral_sample_file(beside, "x").samples.wavelengths == file.samples.wavelengths);
}

TEST_CASE("what are no spectra is refused") {
  const std::string brdf = "# quantity: brdf\n";
  check_text_refused(brdf + angles + "500nm,400nm\n" + at + "1,2\n", {"line 2", "'400nm'", "500 nm", "ascend"});
  check_text_refused(brdf + angles + "400nm,400\n" + at + "1,2\n", {"line 2", "'400'", "none of them twice"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1\n", {"line 3", "5 fields, expected 6"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,2\n" + at + "1,2,3\n", {"line 4", "7 fields"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,nan\n", {"line 3", "column 500nm", "'nan'"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,1e39\n", {"line 3", "column 500nm", "range of float"});
  check_text_refused(brdf + angles + "400nm,500nm\n" + at + "1,\n", {"line 3", "column 500nm"});
  check_text_refused(angles + "400nm,500nm\n" + at + "1,2\n", {"numbers of 400nm", "# quantity: brdf"});
  check_text_refused(brdf + angles + "r,g,b,400nm\n" + at + "1,2,3,4\n", {"two ways", "400nm"});
  check_text_refused(brdf + angles + "value,400nm\n" + at + "1,2\n", {"two ways", "400nm"});
  check_text_refused(brdf + angles + "400nm,wavelength\n" + at + "1,400\n", {"wavelength", "400nm"});
  check_text_refused(brdf + angles + "400nm,500nm,weight_r,weight_g,weight_b\n" + at + "1,2,1,1,1\n", {"one weight"});
  check_text_refused(brdf + angles + "400nm,500nm\n", {"no samples"});
  check_text_refused(angles + "r,g,b\n" + at + "1,2,3\n", {"names no wavelengths", "400nm"});
  check_text_refused(brdf + angles + "value\n" + at + "1\n", {"names no wavelengths"});
  check_refused([&] { return gonio::io::read_samples(brdf + angles + "400nm,500nm\n" + at + "1,2\n", "x"); },
                {"2 columns of wavelengths"});
  // Small numbers are no wavelengths: such columns are ignored as before.
  check_text_refused(brdf + angles + "1,2\n" + at + "1,2\n", {"'r' is missing", "as 400nm"});
}

TEST_CASE("directions are read of files of spectra") {
  const scratch::folder here;
  const auto path = here / "spectra.csv";
  scratch::put(path, angles + "400nm,500nm\n" + at + "1,2\n");
  CHECK(gonio::io::read_directions(path).size() == 1);
}

TEST_CASE("spectra that are written are read back bit by bit") {
  const scratch::folder here;
  gonio::spectral_samples samples{{400.0, 632.8, 1064.0}, {}, gonio::cell_matrix(3, 3), {1.0, 0.25, 0.0}};
  samples.values << 0.1f, 1e-7f, -3.0f, 0.2f, 4.0f, 1e30f, 5.0f, 6.0f, 7.0f;
  for (const double theta_d : {0.1, 0.7, 1.1}) samples.directions.push_back({0.2, theta_d, 1.0});
  const auto path = here / "spectra.csv";
  gonio::io::write_spectral_samples(path, samples, {"arm", "", ""});
  const auto read = gonio::io::read_spectral_sample_file(path);
  CHECK(read.samples.wavelengths == samples.wavelengths);
  CHECK(read.samples.values == samples.values);
  CHECK(read.samples.weights == samples.weights);
  CHECK(read.provenance.instrument == "arm");
  for (Eigen::Index i = 0; i < 3; ++i)
    CHECK(read.samples.directions[i].angles().theta_d ==
          doctest::Approx(samples.directions[i].angles().theta_d).epsilon(1e-12));
  samples.wavelengths[1] = 400.0;
  check_refused([&] { gonio::io::write_spectral_samples(path, samples); }, {"spectra.csv", "wavelength 2"});
}

TEST_CASE("any text of spectra is read or refused") {
  CHECK(rc::check([&] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-+e,;\n#nmw")));
    try {
      const auto file = read_spectral_sample_file("# quantity: brdf\n" + angles + text, "x");
      gonio::require_usable(file.samples);
    } catch (const gonio::error&) {
    }
  }));
}
