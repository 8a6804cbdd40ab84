#include "sample_text.hpp"
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

using gonio::radians;
using gonio::io::quantity_named;
using gonio::io::read_samples;
using gonio::io::sample_quantity;
using scratch::check_refused;
using scratch::check_text_refused;

namespace {

const std::string half_header = "theta_h,theta_d,phi_d,r,g,b\n";

}  // namespace

TEST_CASE("quantities have names") {
  for (const std::string_view name : gonio::io::sample_quantity_names) {
    const auto quantity = quantity_named(name);
    REQUIRE(quantity);
    CHECK(name_of(*quantity) == name);
  }
  CHECK(quantity_named(" Reflectance Factor ") == sample_quantity::reflectance_factor);
  CHECK(quantity_named("BRDF_cosine") == sample_quantity::brdf_cosine);
  CHECK(!quantity_named(""));
  CHECK(!quantity_named("radiance"));
}

TEST_CASE("a white diffuser is 1 / pi in every quantity") {
  const gonio::direction wo = gonio::spherical_direction(gonio::radians(60.0), 1.0);
  const double white = 1.0 / std::numbers::pi;
  CHECK(white * brdf_factor(sample_quantity::brdf, wo) == white);
  CHECK(0.5 * white * brdf_factor(sample_quantity::brdf_cosine, wo) == doctest::Approx(white));
  CHECK(brdf_factor(sample_quantity::reflectance_factor, wo) == doctest::Approx(white));
  CHECK(100.0 * brdf_factor(sample_quantity::percent, wo) == doctest::Approx(white));
}

TEST_CASE("every quantity becomes a BRDF, as option, comment, column, name, unit and percent sign") {
  const double f = 0.2, cosine = std::cos(radians(60)), pi = std::numbers::pi;
  const auto number = [](double value) { return gonio::io::shortest(value); };
  const auto read = [](const std::string& text, std::optional<sample_quantity> quantity = {}) {
    const auto file = gonio::io::read_sample_file(text, "x", {.columns = {}, .quantity = quantity, .note = {}});
    CHECK((file.samples[0].value == file.samples[0].value[0]).all());
    return file.samples[0].value[0];
  };
  const std::string angles = "theta_i,phi_i,theta_o,phi_o,", row = "10,0,60,0,";
  for (const auto& [name, value] : {std::pair{"brdf", f}, std::pair{"brdf-cosine", f * cosine},
                                    std::pair{"reflectance-factor", pi * f}, std::pair{"percent", 100.0 * pi * f}}) {
    CAPTURE(name);
    const std::string text = angles + "value\n" + row + number(value) + "\n";
    const auto quantity = quantity_named(name);
    REQUIRE(quantity);
    CHECK(read(text, quantity) == doctest::Approx(f).epsilon(1e-14));
    CHECK(read("# Quantity: " + std::string(name) + "\n" + text) == doctest::Approx(f).epsilon(1e-14));
    CHECK(read("\"# quantity: " + std::string(name) + "\",,,,\n" + text, quantity) ==
          doctest::Approx(f).epsilon(1e-14));
    CHECK(read(angles + "value,quantity\n" + row + number(value) + "," + name + "\n") ==
          doctest::Approx(f).epsilon(1e-14));
    CHECK(read(angles + name + "\n" + row + number(value) + "\n") == doctest::Approx(f).epsilon(1e-14));
    CHECK(read("# quantity: " + std::string(name) + "\n" + angles + "r,g,b\n" + row + number(value) + "," +
               number(value) + "," + number(value) + "\n") == doctest::Approx(f).epsilon(1e-14));
  }
  CHECK(read(angles + "value [%]\n" + row + number(100.0 * pi * f) + "\n") == doctest::Approx(f).epsilon(1e-14));
  CHECK(read(angles + "Reflectance Factor (%)\n" + row + number(100.0 * pi * f) + "\n") ==
        doctest::Approx(f).epsilon(1e-14));
  CHECK(read(angles + "value\n" + row + "14.59%\n") == doctest::Approx(0.1459 / pi));
  CHECK(read("# quantity: reflectance-factor\n" + angles + "value\n" + row + "14.59 %\n") ==
        doctest::Approx(0.1459 / pi));
  CHECK(read(angles + "value [%],quantity\n" + row + "14.59,reflectance-factor\n" + row + "14.59,percent\n") ==
        doctest::Approx(0.1459 / pi));
  CHECK(read("# quantity: reflectance-factor\n" + angles + "value [%]\n" + row + "14.59\n") ==
        doctest::Approx(0.1459 / pi));
  CHECK(read("theta_i;phi_i;theta_o;phi_o;r;g;b\n10;0;60;0;14,5%;14,5%;14,5%\n") == doctest::Approx(0.145 / pi));
}

TEST_CASE("missing and contradicting quantities are refused") {
  const std::string grey = "theta_h,theta_d,phi_d,value\n1,2,3,4\n";
  check_text_refused(grey, {"line 2", "does not state the quantity of value", "# quantity: brdf", "--quantity"});
  check_text_refused("# quantity: radiance\n" + grey, {"line 1", "'radiance' is unknown", "reflectance-factor"});
  check_text_refused(
      "# quantity: brdf\n# quantity: percent\n" + grey,
      {"line 2", "brdf according to the comment in line 1", "percent according to the comment in line 2"});
  check_text_refused(half_header + "1,2,3,4,5,6\n# quantity: percent\n", {"line 3", "below a sample"});
  check_text_refused("theta_h,theta_d,phi_d,value,quantity\n1,2,3,4,brdf\n1,2,3,4,percent\n", {"line 3", "percent"});
  check_text_refused("theta_h,theta_d,phi_d,value,quantity\n1,2,3,4,light\n", {"line 2", "'light' is unknown"});
  check_text_refused(
      "# quantity: percent\ntheta_h,theta_d,phi_d,BRDF\n1,2,3,4\n",
      {"line 2", "percent according to the comment in line 1", "brdf according to the name of column 'BRDF'"});
  check_text_refused("theta_h,theta_d,phi_d,brdf\n1,2,3,4%\n",
                     {"line 2", "brdf according to", "percent according to their percent signs"});
  check_text_refused("theta_h,theta_d,phi_d,r,g,b\n1,2,3,4%,4%,4\n", {"line 2", "percent signs", "all or none"});
  check_text_refused("theta_h,theta_d,phi_d,r,g,b\n1,2,3,4,4,4\n1,2,3,4%,4%,4%\n", {"line 3", "percent signs"});
  check_text_refused("theta_h,theta_d,phi_d,r,g,b\n1%,2,3,4,4,4\n", {"line 2", "theta_h", "'1%' is not a number"});
  check_refused(
      [&] {
        return read_samples("# quantity: percent\n" + grey, "x",
                            {.columns = {}, .quantity = sample_quantity::brdf, .note = {}});
      },
      {"brdf according to the requested quantity (--quantity)", "percent according to the comment in line 1"});
  check_text_refused("theta_h,theta_d,phi_d,value,r,g,b\n1,2,3,4,4,4,4\n", {"line 1", "two ways", "r,g,b or value"});
}
