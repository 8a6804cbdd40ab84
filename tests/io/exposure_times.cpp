#include "scratch.hpp"
#include <gonio/io/images/exposure_times.hpp>

#include <doctest/doctest.h>

#include <limits>

using gonio::io::exposure_time_of_name;
using gonio::io::read_exposure_times;
using scratch::check_refused;

TEST_CASE("exposure times: names give seconds or fractions of a second") {
  CHECK(exposure_time_of_name("0.004s").value() == 0.004);
  CHECK(exposure_time_of_name("2s").value() == 2.0);
  CHECK(exposure_time_of_name("frame_0.5s").value() == 0.5);
  CHECK(exposure_time_of_name("frame_2_0.5s").value() == 0.5);
  CHECK(exposure_time_of_name("frame_1_250s").value() == 1.0 / 250.0);
  CHECK(exposure_time_of_name("1-250s").value() == 1.0 / 250.0);
  CHECK(exposure_time_of_name("frame01_1e-04s").value() == 1e-4);
  CHECK(exposure_time_of_name("2.5e-3s").value() == 2.5e-3);
  CHECK(exposure_time_of_name("frame-30s").value() == 30.0);
}

TEST_CASE("exposure times: other names give none") {
  for (const char* name :
       {"", "s", "frame", "frames", "0.004", "frame_0.004s_b", "0s", "frame_.s", "1.2.3s", "99999999999s"}) {
    CAPTURE(name);
    CHECK(!exposure_time_of_name(name));
  }
  check_refused([] { return exposure_time_of_name("frame_2_250s"); }, {"frame_2_250s", "'2' and '250'"});
}

TEST_CASE("exposure times: a table is read") {
  const scratch::folder here;
  scratch::put(here / "times.csv", "# of Monday\nfile,seconds\na.png, 0.5\n\"b, c.png\" ,1/250\n");
  const auto times = read_exposure_times(here / "times.csv");
  CHECK(times.size() == 2);
  CHECK(times.at("a.png") == 0.5);
  CHECK(times.at("b, c.png") == 1.0 / 250.0);
  scratch::put(here / "german.csv", "file;seconds\na.png;0,5\nb, c.png;1/250\n");
  CHECK(read_exposure_times(here / "german.csv") == times);
}

TEST_CASE("exposure times: times from 1e-7 s to a day are plausible") {
  for (const double seconds : {1e-7, 0.5, 86400.0}) CHECK_NOTHROW(gonio::io::require_believable_exposure(seconds, "a"));
  for (const double seconds : {0.99e-7, 86401.0, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_WITH_AS(gonio::io::require_believable_exposure(seconds, "a.jpg"),
                         doctest::Contains("a.jpg: an exposure time of"), gonio::error);
}

TEST_CASE("exposure times: bad tables are refused") {
  const scratch::folder here;
  const auto refuses = [&](const std::string& text, const std::string& words) {
    scratch::put(here / "times.csv", text);
    check_refused([&] { return read_exposure_times(here / "times.csv"); }, {"times.csv", words});
  };
  refuses("", "has no exposure time");
  refuses("file,seconds\n", "has no exposure time");
  refuses("a.png,0.5\n", "line 1: expected the header");
  refuses("file,seconds\na.png\n", "line 2: 1 field, expected 2");
  for (const char* seconds : {"0", "-1", "nan", "inf", "1/0", "1/", "x", ""})
    refuses(std::string("file,seconds\na.png,") + seconds, "line 2: expected a file and a positive number");
  refuses("file,seconds\n,1\n", "expected a file");
  refuses("file,seconds\nb, c.png,1\n", "line 2: 3 fields, expected 2");
  refuses("file,seconds\na.png,1\na.png,2\n", "line 3: the file 'a.png' appears twice");
  scratch::check_refuses_non_files([](const auto& path) { return read_exposure_times(path); });
}
