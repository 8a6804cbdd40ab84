#include "scratch.hpp"
#include <gonio/io/measurements/rt300s.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <initializer_list>
#include <numbers>
#include <string>

using gonio::degrees;
using gonio::io::read_rt300s;
using scratch::check_refused;

namespace {

const std::string start =
                      "DataType:\tBRDF(RT-300S)\t \t\rSampleID:\tmade up\t \t\rIncidence:\t20\t \t\rRaw data\t\t\t\r",
                  exported = start + "\t-20\t0\t60\r-90\t11\t12\t13\r0\t21\t22\t-23\r\t\t\t\r",
                  sheet =
                      " Method\tBRDF_LD\tBRDF_LD\tBRDF_LD\n Azimuth\t-90.0\t0\t90\n Incidence\t20\t20\t\n"
                      " Receive\t20\t60\t\n L\t\t\t\n RT\t0.11\t-.13\t\n380.0\t1\t2\t3\n";

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  REQUIRE(text.find(old) != std::string::npos);
  return text.replace(text.find(old), old.size(), fresh);
}

void check_rt300s_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_rt300s(text, "black.jdv"); }, {"black.jdv"});
  check_refused([&] { return read_rt300s(text, "black.jdv"); }, words);
}

}  // namespace

TEST_CASE("RT-300S: a value for each azimuth and angle of the receiver, in percent times the cosine") {
  const auto samples = read_rt300s(exported + with(exported, "20\t \t", "30\t \t"), "x");
  REQUIRE(samples.size() == 12);
  CHECK(samples[1].value.x() * std::numbers::pi == doctest::Approx(0.12));
  CHECK(samples[5].value.x() * std::numbers::pi == doctest::Approx(-0.23 / 0.5));
  CHECK(degrees(samples[0].angles().theta_h) == doctest::Approx(20.0));  // the light's direction
  CHECK(degrees(samples[2].angles().theta_h) == doctest::Approx(20.0));  // past the mirror direction
  CHECK(degrees(samples[2].angles().theta_d) == doctest::Approx(40.0));
  const auto& [wi, wo] = samples[5].directions.pair();
  CHECK(degrees(gonio::polar_angle(wo)) == doctest::Approx(60.0));
  CHECK(degrees(gonio::azimuth(wo) - gonio::azimuth(wi)) == doctest::Approx(-90.0));
  CHECK(degrees(gonio::polar_angle(samples[6].directions.pair().wi)) == doctest::Approx(30.0));
}

TEST_CASE("RT-300S: the sheet has a column for each reading") {
  const auto samples = read_rt300s(sheet, "x");
  REQUIRE(samples.size() == 2);
  CHECK(degrees(samples[0].angles().theta_h) == doctest::Approx(0.0));  // the mirror direction
  CHECK(samples[0].value.x() * std::numbers::pi == doctest::Approx(0.11 / std::cos(gonio::radians(20.0))));
  CHECK(samples[1].value.x() * std::numbers::pi == doctest::Approx(-0.26));
  CHECK(read_rt300s("Method;BRDF_LD\nAzimuth;0\nIncidence;22,5\nReceive;-60\nRT;0,5\n", "x")[0].value.x() *
            std::numbers::pi ==
        doctest::Approx(1.0));
}

TEST_CASE("RT-300S: a file is recognised by its first line") {
  CHECK(gonio::io::looks_like_rt300s(exported));
  CHECK(gonio::io::looks_like_rt300s(sheet));
  CHECK_FALSE(gonio::io::looks_like_rt300s(with(exported, "RT-300S", "Raywiz")));
  CHECK_FALSE(gonio::io::looks_like_rt300s("Method\tColour\n"));
  CHECK_FALSE(gonio::io::looks_like_rt300s(""));
}

TEST_CASE("RT-300S: bad files are refused") {
  check_rt300s_refused("", {"is empty", "BRDF(RT-300S)"});
  check_rt300s_refused("a\n", {"line 1", "'a'", "DataType: BRDF(RT-300S)"});
  check_rt300s_refused(with(exported, "BRDF", "BTDF"), {"line 1", "'BTDF(RT-300S)'"});
  check_rt300s_refused(with(exported, "Incidence:\t20", "Incidence:\tsteep"), {"line 3", "Incidence", "'steep'"});
  check_rt300s_refused(with(exported, "Incidence:\t20", "Incidence:\t91"),
                       {"line 3", "Incidence (degrees): 91", "0 to 90"});
  check_rt300s_refused(with(exported, "Incidence", "Inclination"), {"line 4", "no line Incidence"});
  check_rt300s_refused(exported + with(exported, "Incidence", "Inclination"), {"line 12", "no line Incidence"});
  check_rt300s_refused(with(exported, "Raw data", "Data"), {"line 4", "'Data'", "'Raw data'"});
  check_rt300s_refused(with(exported, "\t-20\t0\t60\r", ""), {"line 5", "'-90'", "an empty field"});
  check_rt300s_refused(with(exported, "\t60", "\t95"), {"line 5", "the receiver's angle (degrees): 95"});
  check_rt300s_refused(with(exported, "-90\t", "-900\t"), {"line 6", "the azimuth (degrees): -900"});
  check_rt300s_refused(with(exported, "\t12", "\tx"), {"line 6", "a value", "'x'"});
  check_rt300s_refused(with(exported, "\t12", "\tnan"), {"line 6", "not finite"});
  check_rt300s_refused(with(exported, "\t12", "\t1e42"), {"line 6", "range of float"});
  check_rt300s_refused(with(exported, "\t12\t", "\t"), {"line 6", "3 fields", "an azimuth and 3 values"});
  check_rt300s_refused(start, {"no sample"});
  check_rt300s_refused(with(sheet, " RT", " R"), {"has no row RT"});
  check_rt300s_refused(with(sheet, " Receive", " Receiver"), {"line 6", "above the row RT"});
  check_rt300s_refused(with(sheet, "20\t60", "20\t"), {"line 6", "reading 2 has RT"});
  check_rt300s_refused(with(sheet, "20\t60", "20\t160"), {"line 6", "Receive (degrees): 160"});
  check_rt300s_refused(with(sheet, "20\t20", "20\t-20"), {"line 6", "Incidence (degrees): -20"});
  check_rt300s_refused(with(sheet, "-90.0", "-900"), {"line 6", "Azimuth (degrees): -900"});
  check_rt300s_refused(with(sheet, "0.11", "high"), {"line 6", "RT: 'high'"});
  check_rt300s_refused(with(sheet, "\t-.13", ""), {"line 6", "expected 4"});
  scratch::check_refuses_non_files([](const auto& path) { return read_rt300s(path); });
}

TEST_CASE("RT-300S: any text is read or refused") {
  CHECK(rc::check([] {
    for (std::string all : {exported, sheet}) {
      const auto where = *rc::gen::inRange<std::size_t>(0, all.size());
      const auto fresh = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-\t\n e")));
      all.replace(where, *rc::gen::inRange<std::size_t>(0, 10), fresh);
      try {
        for (const gonio::sample& s : read_rt300s(all, "x")) RC_ASSERT(s.value.isFinite().all());
      } catch (const gonio::error&) {
      }
    }
  }));
}
