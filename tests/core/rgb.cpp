#include "../golden.hpp"
#include <gonio/core/rgb.hpp>

#include <doctest/doctest.h>

using gonio::rgb;

TEST_CASE("CIELAB agrees with the reference") {
  const auto golden = golden_csv("lab.csv");
  for (std::size_t i = 0; i < golden.at("r").size(); ++i) {
    CAPTURE(i);
    const rgb lab = gonio::to_lab({golden.at("r")[i], golden.at("g")[i], golden.at("b")[i]});
    CHECK(lab.x() == doctest::Approx(golden.at("L")[i]).epsilon(1e-10).scale(1));
    CHECK(lab.y() == doctest::Approx(golden.at("a")[i]).epsilon(1e-10).scale(1));
    CHECK(lab.z() == doctest::Approx(golden.at("b_")[i]).epsilon(1e-10).scale(1));
  }
}

TEST_CASE("the difference of a colour with itself is zero, of black and white 100") {
  CHECK(gonio::delta_e({0.2, 0.5, 0.7}, {0.2, 0.5, 0.7}) == 0.0);
  CHECK(gonio::delta_e(rgb::Zero(), rgb::Ones()) == doctest::Approx(100.0).epsilon(1e-4));
  CHECK(gonio::delta_e(rgb::Ones(), rgb::Constant(7.0)) == 0.0);  // both are clipped to white
}

TEST_CASE("luminance weights sum to one and sRGB meets its published points") {
  CHECK(gonio::luminance(rgb::Ones()) == doctest::Approx(1.0));
  CHECK(gonio::encode_srgb(0.0) == 0.0);
  CHECK(gonio::encode_srgb(1.0) == doctest::Approx(1.0));
  CHECK(gonio::encode_srgb(0.21404114) == doctest::Approx(0.5).epsilon(1e-6));
  CHECK(gonio::encode_srgb(-3.0) == 0.0);
  CHECK(gonio::encode_srgb(0.0031308) == doctest::Approx(0.04045).epsilon(1e-3));
}

TEST_CASE("XYZ and back") {
  for (const rgb& colour : {rgb(1, 1, 1), rgb(0.2, 0.5, 0.9), rgb(-0.1, 2.0, 0.0)})
    CHECK(((gonio::from_xyz(gonio::to_xyz(colour)) - colour).abs() < 2e-6).all());  // the matrices have 7 digits
}
