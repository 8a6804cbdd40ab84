#include "scratch.hpp"
#include <gonio/io/measurements/fred_bsdf.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <initializer_list>
#include <string>

using gonio::degrees;
using gonio::io::read_fred_bsdf;
using scratch::check_refused;

namespace {

const std::string start = "type bsdf_data\r\nformat angles=deg bsdf=value scale=1\r\n";

void check_fred_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_fred_bsdf(text, "black.txt"); }, {"black.txt"});
  check_refused([&] { return read_fred_bsdf(text, "black.txt"); }, words);
}

}  // namespace

TEST_CASE("FRED: a value for each pair of directions; equal azimuths mean the mirror direction's side") {
  const auto samples =
      read_fred_bsdf(start + "10\t0\n0\t0\t.1\n10 0 .2\n\n50\t20\n50\t20\t.5\n30\t110\t-.25\n90 0 1\n", "x");
  REQUIRE(samples.size() == 4);  // the last is at the horizon
  CHECK(samples[1].value.x() == 0.2);
  CHECK(samples[1].angles().theta_h < 1e-6);
  CHECK(samples[2].angles().theta_h < 1e-6);
  CHECK(samples[3].value.x() == -0.25);
  const auto& [wi, wo] = samples[3].directions.pair();
  CHECK(degrees(gonio::polar_angle(wi)) == doctest::Approx(50.0));
  CHECK(degrees(gonio::azimuth(wi)) == doctest::Approx(-160.0));
  CHECK(degrees(gonio::polar_angle(wo)) == doctest::Approx(30.0));
  CHECK(degrees(gonio::azimuth(wo)) == doctest::Approx(110.0));
}

TEST_CASE("FRED: a file is recognised by its first line") {
  CHECK(gonio::io::looks_like_fred_bsdf(start));
  CHECK_FALSE(gonio::io::looks_like_fred_bsdf("type bsdf\n"));
}

TEST_CASE("FRED: bad files are refused") {
  check_fred_refused("", {"ends before"});
  check_fred_refused("type bsdf_data\n", {"ends before", "'format'"});
  check_fred_refused("type bsdf\n", {"line 1", "'type bsdf'", "'type bsdf_data'"});
  check_fred_refused("type bsdf_data\nformat angles=deg bsdf=log scale=1\n", {"line 2", "bsdf=log", "bsdf=value"});
  check_fred_refused("type bsdf_data\nformat angles=deg bsdf=value scale=2\n", {"line 2", "scale=1"});
  check_fred_refused(start, {"no sample"});
  check_fred_refused(start + "1 2 3\n", {"line 3", "3 numbers", "two angles of the light"});
  check_fred_refused(start + "10 0\n5\n", {"line 4", "1 number,"});
  check_fred_refused(start + "10 0\n5 0 x\n", {"line 4", "a value", "'x'"});
  check_fred_refused(start + "10 0\n5 0 nan\n", {"line 4", "not finite"});
  check_fred_refused(start + "10 0\n5 0 1e39\n", {"line 4", "range of float"});
  check_fred_refused(start + "10 0\n95 0 1\n", {"line 4", "polar angle is 95"});
  check_fred_refused(start + "10 400\n", {"line 3", "azimuth is 400"});
  scratch::check_refuses_non_files([](const auto& path) { return read_fred_bsdf(path); });
}

TEST_CASE("FRED: any text is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-e \n#")));
    try {
      for (const gonio::sample& s : read_fred_bsdf(start + text, "x")) RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
