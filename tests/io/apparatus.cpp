#include <gonio/io/setups/apparatus.hpp>

#include <doctest/doctest.h>

using gonio::degrees;
using gonio::io::read_apparatus;

TEST_CASE("every rule is read") {
  const auto apparatus = read_apparatus(
      "# an arc\nlight 0 75\nviewer 5 80.5\n\n separation 15 # of the arms\nlight_step 7.5 0.25\r\nforbid 60 90 70 "
      "90\nforbid 0 5 0 5\npair 45 10 20 190\nnoise 0.02\ndark_signal 1e-4\nmisplaced 0.25\n",
      "arc.txt");
  const auto& constraint = apparatus.constraint;
  CHECK(degrees(constraint.light.largest) == doctest::Approx(75));
  CHECK(degrees(constraint.viewer.smallest) == doctest::Approx(5));
  CHECK(degrees(constraint.viewer.largest) == doctest::Approx(80.5));
  CHECK(degrees(constraint.smallest_separation) == doctest::Approx(15));
  CHECK(degrees(constraint.light_step) == doctest::Approx(7.5));
  CHECK(degrees(constraint.light_tolerance) == doctest::Approx(0.25));
  REQUIRE(constraint.forbidden.size() == 2);
  CHECK(degrees(constraint.forbidden[0].viewer.smallest) == doctest::Approx(70));
  REQUIRE(constraint.pairs.size() == 1);
  CHECK(degrees(gonio::polar_angle(constraint.pairs[0].wi)) == doctest::Approx(45));
  CHECK(degrees(gonio::azimuth(constraint.pairs[0].wo)) == doctest::Approx(-170));
  CHECK(apparatus.noise == 0.02);
  CHECK(apparatus.dark_signal == 1e-4);
  CHECK(degrees(apparatus.angular_error) == doctest::Approx(0.25));
  const auto none = read_apparatus("", "nothing");
  CHECK(none.constraint.is_none());
  CHECK(none.noise == 0.0);
}

TEST_CASE("a bad rule is refused; the error names file and line") {
  const auto refused = [](const char* text, const char* why) {
    CHECK_THROWS_WITH_AS(static_cast<void>(read_apparatus(text, "arc.txt")), doctest::Contains(why), gonio::error);
  };
  refused("light 0 75\nlamp 3\n", "arc.txt, line 2: 'lamp' is not a rule");
  refused("light 0\n", "'light' takes 2 or 3 numbers, not 1");
  refused("light 80 20\n", "the smaller one first");
  refused("viewer 0 120\n", "from 0 to 90");
  refused("separation wide\n", "'wide' is not a number");
  refused("separation nan\n", "not finite");
  refused("light_step 0\n", "must be positive");
  refused("light_step 7.5 -1\n", "tolerance of an angle must be from 0 to 90 degrees");
  refused("light_step 7.5 91\n", "tolerance of an angle must be from 0 to 90 degrees");
  refused("light_step 1 2 3\n", "1 or 2 numbers, not 3");
  refused("forbid 0 90\n", "takes 4 numbers");
  refused("light 0 90 -1\n", "tolerance of an angle must be from 0 to 90 degrees");
  refused("in_plane 91\n", "tolerance of an angle must be from 0 to 90 degrees");
  refused("in_plane 1 2\n", "0 or 1 numbers, not 2");
  refused("pair 45 0 20\n", "takes 4 numbers");
  refused("pair 45 0 90 0\n", "at least 0 and less than 90");
  refused("noise 1\n", "'noise' must be at least 0 and less than 1");
  refused("dark_signal -1\n", "'dark_signal' must be at least 0 and less than 1");
  refused("misplaced 45\n", "'misplaced' must be at least 0 and less than 45");
}

TEST_CASE("a single angle has a tolerance by default, a range only if stated") {
  const auto one = read_apparatus("light 45 45\nviewer 10 60\n", "arc.txt").constraint;
  CHECK(degrees(one.light.smallest) == doctest::Approx(44.5));
  CHECK(degrees(one.light.largest) == doctest::Approx(45.5));
  CHECK(degrees(one.viewer.largest) == doctest::Approx(60));
  CHECK_FALSE(one.plane_tolerance);
  const auto wide = read_apparatus("light 45 45 2\nviewer 10 60 1\nin_plane\n", "arc.txt").constraint;
  CHECK(degrees(wide.light.largest) == doctest::Approx(47));
  CHECK(degrees(wide.viewer.smallest) == doctest::Approx(9));
  REQUIRE(wide.plane_tolerance);
  CHECK(degrees(*wide.plane_tolerance) == doctest::Approx(0.5));
}
