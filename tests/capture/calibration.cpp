#include <gonio/capture/calibration.hpp>

#include <doctest/doctest.h>

using gonio::capture::camera_response;
using gonio::capture::measure_reflectance;
using gonio::capture::reading;

namespace {

const std::array linear_cameras{camera_response::power_law(4095), camera_response::power_law(4095),
                                camera_response::power_law(4095)};

/// Returns the counts of a linear 12-bit camera at the note's exposure times, in four pixels.
reading photographed(const gonio::rgb& per_second) {
  reading taken;
  for (const double time : gonio::capture::note_exposure_times) {
    gonio::capture::camera_frame counts(4, 3);
    for (Eigen::Index pixel = 0; pixel < 4; ++pixel)
      for (Eigen::Index channel = 0; channel < 3; ++channel)
        counts(pixel, channel) = static_cast<std::uint16_t>(std::lround(std::min(4095.0, time * per_second[channel])));
    taken.times.push_back(time);
    taken.frames.push_back(counts);
  }
  return taken;
}

const gonio::direction_pair somewhere{gonio::spherical_direction(0.4, 0.0), gonio::spherical_direction(0.7, 2.0)};
const gonio::capture::calibration known{linear_cameras, {.read = 1.0, .shot = 0.0, .relative = 0.01}, 0.99};

}  // namespace

TEST_CASE("calibration: the ratio to the white reference is the BRDF") {
  const auto found = measure_reflectance(photographed({10'000, 20'000, 40'000}), photographed({20'000, 20'000, 20'000}),
                                         somewhere, known);
  REQUIRE(found.is_usable());
  const gonio::rgb expected = gonio::rgb(0.5, 1.0, 2.0) * 0.99 / std::numbers::pi;
  CHECK(((found.value - expected).abs() < 2e-3 * expected).all());
  // With five exposures, or three that do not saturate, the deviation is about one percent each.
  CHECK(found.relative_deviation() > 0.004);
  CHECK(found.relative_deviation() < 0.012);
  const gonio::sample as_sample = found.as_sample();
  CHECK(as_sample.weight == found.weights());
  CHECK(as_sample.angles().theta_d == doctest::Approx(gonio::to_half_difference(somewhere.wi, somewhere.wo).theta_d));
}

TEST_CASE("calibration: the ratio to the lamp is the BRDF, too") {
  const std::vector<reading> looks{photographed({15'000, 20'000, 25'000}), photographed({17'000, 20'000, 23'000})};
  const auto exposures = gonio::capture::mean_exposures(looks, known);
  const auto found = measure_reflectance(photographed({8'000, 10'000, 12'000}),
                                         gonio::capture::measured_lamp{exposures, 0.002, 0.01}, somewhere, known);
  REQUIRE(found.is_usable());
  const double expected = 0.5 * 0.01 / 0.002 / somewhere.wi.z();
  CHECK(((found.value - expected).abs() < 2e-3 * expected).all());
  // The mean of two readings has half the variance of one.
  const double one = gonio::capture::mean_exposures(std::span(looks).first(1), known)[1].relative_deviation();
  CHECK(exposures[1].relative_deviation() == doctest::Approx(one / std::sqrt(2.0)));
  using doctest::Contains;
  CHECK_THROWS_WITH_AS(gonio::capture::mean_exposures({}, known), Contains("at least one reading"), gonio::error);
  const std::vector<reading> bright{looks[0], photographed({1e6, 1e6, 1e6})}, dark{photographed({0, 0, 0})};
  CHECK_THROWS_WITH_AS(gonio::capture::mean_exposures(bright, known), Contains("reading 2 is saturated"), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::capture::mean_exposures(dark, known), Contains("reading 1 is dark"), gonio::error);
}

TEST_CASE("calibration: surfaces at other positions are corrected for") {
  // The cosine is half as large and the distance twice as long: an eighth of the light.
  const auto found =
      measure_reflectance(photographed({2'000, 2'000, 2'000}), photographed({16'000, 16'000, 16'000}), somewhere, known,
                          {.cosine = 0.5, .distance = 2.0}, {.cosine = 1.0, .distance = 1.0});
  REQUIRE(found.is_usable());
  CHECK(found.value.x() == doctest::Approx(0.99 / std::numbers::pi).epsilon(2e-3));
}

TEST_CASE("calibration: a reference measured under other lights is used with the nearest light and both cosines") {
  const auto pose = [](double light, double viewer) {
    return gonio::direction_pair{gonio::spherical_direction(light, 0.0), gonio::spherical_direction(viewer, 1.0)};
  };
  // A matte reference: one lamp gives 20,000 counts per second from directly above, another is twice as bright.
  const auto white_at = [&](double light, double lamp) {
    return photographed(gonio::rgb::Constant(lamp * std::cos(light)));
  };
  const gonio::capture::reference_readings reference({pose(0.3, 0.1), pose(1.0, 0.2)},
                                                     {white_at(0.3, 20'000.0), white_at(1.0, 40'000.0)});
  for (const auto& [light, lamp] : {std::pair{0.5, 20'000.0}, std::pair{0.8, 40'000.0}}) {
    // The material is half as bright as the reference would be at this pose.
    const auto found =
        reference.measure(photographed(gonio::rgb::Constant(0.5 * lamp * std::cos(light))), pose(light, 0.9), known);
    REQUIRE(found.is_usable());
    CHECK(found.value.x() == doctest::Approx(0.5 * 0.99 / std::numbers::pi).epsilon(2e-3));
    CHECK(found.at.wi == pose(light, 0.9).wi);
  }
  using gonio::capture::reference_readings;
  CHECK_THROWS_WITH_AS(reference_readings({}, {}), "a reference needs at least one reading", gonio::error);
  CHECK_THROWS_WITH_AS(reference_readings({pose(0.1, 0.2), pose(0.3, 0.1)}, {white_at(0.1, 20'000.0)}),
                       "a reference has 1 readings at 2 poses, expected one at each", gonio::error);
}

TEST_CASE("calibration: a table corrects a reference that is darker at grazing light, also at another pose") {
  const auto pose = [](double light) {
    return gonio::direction_pair{gonio::spherical_direction(light, 0.0), gonio::spherical_direction(0.2, 1.0)};
  };
  const gonio::rgb above(0.99, 0.98, 0.97), grazing(0.8, 0.7, 0.6);
  gonio::capture::calibration with_table = known;
  with_table.reflectance = {{0.0, 1.5}, {}, {above, grazing}};
  const reading grey = photographed(gonio::rgb::Constant(10'000.0));
  const auto beside = [&](const gonio::rgb& factor) { return photographed(20'000.0 * factor); };
  for (const auto& [light, factor] : {std::pair{0.0, above}, std::pair{1.5, grazing}}) {
    const auto found = measure_reflectance(grey, beside(factor), pose(light), with_table);
    CHECK(((found.value * std::numbers::pi - 0.5).abs() < 2e-3).all());
    const auto without = measure_reflectance(grey, beside(factor), pose(light), known);
    CHECK(((without.value * std::numbers::pi - 0.5 * 0.99 / factor).abs() < 2e-3).all());
    CHECK(found.relative_deviation() == doctest::Approx(without.relative_deviation()).epsilon(0.05));
  }
  // The reflectance factor is taken at the pose at which the reference was measured.
  const gonio::capture::reference_readings reference({pose(0.0)}, {beside(above)});
  const auto found =
      reference.measure(photographed(gonio::rgb::Constant(10'000.0 * std::cos(1.0))), pose(1.0), with_table);
  CHECK(((found.value * std::numbers::pi - 0.5).abs() < 2e-3).all());
  with_table.reflectance = {{0.0, 1.0}, {}, {above, grazing}};
  CHECK_THROWS_WITH_AS(measure_reflectance(grey, grey, pose(1.5), with_table), doctest::Contains("covers theta_i"),
                       gonio::error);
}

TEST_CASE("calibration: unusable values give the reason") {
  const reading white = photographed({20'000, 20'000, 20'000}), black = photographed({0, 0, 0}),
                bright = photographed({1e6, 1e6, 1e6});
  CHECK(measure_reflectance(bright, white, somewhere, known).doubt == "saturated in every exposure");
  CHECK(measure_reflectance(photographed({10'000, 10'000, 1e6}), white, somewhere, known).doubt ==
        "saturated in every exposure");
  CHECK(measure_reflectance(black, white, somewhere, known).doubt == "dark in every exposure");
  CHECK(measure_reflectance(white, black, somewhere, known).doubt == "the reference is dark");
  CHECK(measure_reflectance(white, bright, somewhere, known).doubt == "the reference is saturated");
  // A colour may be zero in one channel.
  const auto yellow = measure_reflectance(photographed({10'000, 10'000, 0}), white, somewhere, known);
  CHECK(yellow.is_usable());
  CHECK(yellow.value.z() == 0.0);
  CHECK(yellow.deviation.z() > 0.0);
  CHECK(yellow.as_sample().weight[0] > 0.3);
}

TEST_CASE("calibration: each channel has the weight of its own deviation, a paint's near-black channel the smallest") {
  const auto measured = [](const gonio::rgb& value, const gonio::rgb& deviation) {
    return gonio::capture::measured_reflectance{somewhere, value, deviation}.as_sample().weight;
  };
  // Noise of 0.002 is 1 % of red and 100 % of green.
  const auto red = measured({0.2, 0.002, 0.0}, gonio::rgb::Constant(0.002));
  CHECK(red[0] > 0.99);
  CHECK(red[1] < 0.75);
  CHECK(red[2] < 0.25);
  CHECK(red[2] > 0.1);  // the measurement does show that blue is dark
  // For a value below the offset of the logarithm, the deviation is relative to the offset.
  CHECK(measured({0.0, 0.0, 0.0}, gonio::rgb::Constant(1e-6)).is_uniform());
  CHECK(measured({0.0, 0.0, 0.0}, gonio::rgb::Constant(1e-6))[0] == doctest::Approx(1.0).epsilon(0.01));
}

TEST_CASE("calibration: the responses of the three colours come from the times that all readings share") {
  std::vector<reading> readings;
  for (const double brightness : {300.0, 900.0, 2'500.0, 7'000.0, 20'000.0, 50'000.0, 120'000.0})
    readings.push_back(photographed({brightness, 0.5 * brightness, 0.2 * brightness}));
  // A highlight saturates one pixel of a measurement, so its mean is unusable.
  for (auto& frame : readings[2].frames) frame.row(1).setConstant(4095);
  readings[1].times.push_back(0.8);
  readings[1].frames.push_back(gonio::capture::camera_frame::Constant(4, 3, 4095));
  for (const camera_response& each : gonio::capture::estimate_responses(readings, 4095))
    for (const double count : {200.0, 500.0, 1'000.0, 3'000.0})
      CHECK(each.exposure(count) == doctest::Approx(count / 2047.5).epsilon(0.01));

  using doctest::Contains;
  CHECK_THROWS_WITH_AS((void)gonio::capture::estimate_responses({}, 4095), Contains("needs at least one reading"),
                       gonio::error);
  readings.push_back({{0.05}, {gonio::capture::camera_frame::Constant(4, 3, 100)}});
  CHECK_THROWS_WITH_AS((void)gonio::capture::estimate_responses(readings, 4095),
                       Contains("common exposure times, not 1"), gonio::error);
}

TEST_CASE("calibration: frames with a saturated pixel or at extrapolated counts are ignored") {
  reading uneven = photographed({10'000, 10'000, 10'000});
  uneven.frames[4](2, 0) = 4095;            // in the frame of 0.2 s: leaving it out would change the mean
  uneven.frames[0].col(1) = 0;              // in the frame of 12.5 ms: wrong, but too dark to be noticed
  uneven.frames[0].col(2).setConstant(20);  // below the first knot
  const auto found = measure_reflectance(uneven, photographed({20'000, 20'000, 20'000}), somewhere, known);
  REQUIRE(found.is_usable());
  INFO((found.value * std::numbers::pi / 0.99).transpose());
  CHECK(((found.value * std::numbers::pi / 0.99 - 0.5).abs() < 2e-3).all());
}

TEST_CASE("calibration: a reference darker than most samples is refused") {
  const gonio::direction up(0.0, 0.0, 1.0), aslant = gonio::spherical_direction(gonio::radians(50.0), 0.0);
  // Values relative to white, half of them in highlights.
  const auto measured = [&](std::initializer_list<double> highlights, std::initializer_list<double> others) {
    std::vector<gonio::capture::measured_reflectance> all;
    const auto add = [&](const gonio::direction_pair& at, double share) {
      all.push_back({at, gonio::rgb(0.5, 1.5, 1.0) * share * 0.99 / std::numbers::pi, gonio::rgb::Zero(), ""});
    };
    for (const double share : highlights) add({up, up}, share);
    for (const double share : others) add({up, aslant}, share);
    return all;
  };
  const auto accepts = [](const auto& all) { gonio::capture::require_bright_reference(all, 0.99); };
  accepts(measured({}, {}));
  accepts(measured({0.5, 7.0}, {0.2, 0.9}));
  accepts(measured({9.0, 7.0}, {0.2, 0.9}));
  accepts(measured({9.0, 7.0, 0.1}, {1.2, 0.9, 0.8}));
  accepts(measured({1.04, 1.04}, {1.04}));  // another white material
  using doctest::Contains;
  CHECK_THROWS_WITH_AS(accepts(measured({9.0, 7.0}, {0.2})), Contains("darker than the material in 2 of 3 samples"),
                       gonio::error);
  // White next to red paint, which is brighter only in its highlights.
  CHECK_THROWS_WITH_AS(accepts(measured({0.02, 0.1, 0.3}, {9.0, 0.7, 4.0})),
                       Contains("in 2 of the 3 samples outside the highlight"), gonio::error);
}
