#include "sample_text.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

using gonio::io::read_samples;
using scratch::check_refused;
using scratch::check_text_refused;

TEST_CASE("angles are in radians if their columns state it") {
  const auto samples = read_samples("theta_h [rad],theta_d (radians),phi_d_rad,r,g,b\n0.5,0.25,1,1,1,1\n", "x");
  CHECK(samples[0].angles().theta_h == doctest::Approx(0.5));
  CHECK(samples[0].angles().theta_d == doctest::Approx(0.25));
  CHECK(samples[0].angles().phi_d == doctest::Approx(1.0));
  check_text_refused("theta_h [mrad],theta_d,phi_d,r,g,b\n1,1,1,1,1,1\n",
                     {"line 1", "'theta_h' is missing", "perhaps it is 'theta_h [mrad]'"});
}

TEST_CASE("ignored columns and assumptions are noted") {
  std::vector<std::string> notes;
  const gonio::io::sample_reading reading{
      .columns = {}, .quantity = {}, .note = [&](const std::string& sentence) { notes.push_back(sentence); }};
  (void)read_samples("theta_h,theta_d,phi_d,r,g,b\n1,2,3,1,1,1\n", "paint.csv", reading);
  CHECK(notes.empty());
  (void)read_samples("theta_h,theta_d,phi_d,r,g,b,Temperature,wieght\n1,2,3,1,1,1,20 C,1\n", "paint.csv", reading);
  (void)read_samples("theta_i,theta_o,r,g,b\n30,-30,1,1,1\n", "paint.csv", reading);
  REQUIRE(notes.size() == 2);
  CHECK(notes[0] == "paint.csv: columns 'Temperature', 'wieght' (is it weight?) are ignored");
  CHECK(
      notes[1].starts_with("paint.csv: there are no columns phi_i and phi_o: light and viewer are taken to be on the "
                           "same side of the normal where theta_i and theta_o have the same sign"));
}

TEST_CASE("the caller can name columns") {
  const gonio::io::sample_reading named{.columns = {{"theta_o", "winkel"}, {"value", "Y (D65)"}},
                                        .quantity = gonio::io::sample_quantity::brdf,
                                        .note = {}};
  const auto samples = read_samples("theta_i;phi_i;Winkel [deg];phi_o;Y (D65)\n0;0;60;0;0,5\n", "x", named);
  CHECK(samples[0].directions.pair().wo.z() == doctest::Approx(0.5));
  CHECK(samples[0].value[2] == 0.5);
  // The column that would be theta_o is ignored.
  const auto both = read_samples("theta_i;phi_i;Winkel;theta_o;phi_o;Y (D65)\n0;0;60;1;0;0,5\n", "x", named);
  CHECK(both[0].directions.pair().wo.z() == doctest::Approx(0.5));
  check_refused([&] { return read_samples("theta_i,phi_i,angle,phi_o,Y (D65)\n0,0,60,0,1\n", "x", named); },
                {"no column 'winkel' for theta_o", "looks comma-separated", "'angle'"});
  const gonio::io::sample_reading wrong{.columns = {{"theta", "Winkel"}}, .quantity = {}, .note = {}};
  check_refused([&] { return read_samples("theta_h,theta_d,phi_d,r,g,b\n1,2,3,4,5,6\n", "x", wrong); },
                {"samples have no column 'theta'", "'Winkel'"});
}
