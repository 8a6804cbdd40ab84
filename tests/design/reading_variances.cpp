#include "../synthetic_materials.hpp"
#include <gonio/design/reading_variances.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace {

const gonio::log_relative_pca& small_prior() {
  static const auto prior = learn(synthetic_materials(small_cells(), 12), 10);
  return prior;
}

std::vector<gonio::location> all_locations() {
  std::vector<gonio::location> all;
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    all.push_back(gonio::locate_cell(small_cells(), cell));
  return all;
}

}  // namespace

TEST_CASE("an apparatus without errors adds none; each of its errors adds its own variance") {
  const auto locations = all_locations();
  CHECK(gonio::design::reading_variances({}, small_prior(), locations).isZero());
  gonio::design::apparatus relative, dark, off;
  relative.noise = 0.02;
  dark.dark_signal = 1e-3;
  off.angular_error = gonio::radians(0.5);
  gonio::design::apparatus all = relative;
  all.dark_signal = dark.dark_signal;
  all.angular_error = off.angular_error;
  const Eigen::VectorXd of_noise = gonio::design::reading_variances(relative, small_prior(), locations),
                        of_dark = gonio::design::reading_variances(dark, small_prior(), locations),
                        of_angles = gonio::design::reading_variances(off, small_prior(), locations);
  CHECK(of_noise == gonio::map_noise(small_prior(), locations, 0.02).variance);
  CHECK(gonio::design::reading_variances(all, small_prior(), locations).isApprox(of_noise + of_dark + of_angles));
  const double observations = static_cast<double>(small_prior().coefficients().rows());
  for (const Eigen::Index cell : {Eigen::Index{0}, Eigen::Index{77}, Eigen::Index{150}}) {
    const auto pair = gonio::to_directions(locations[cell].angles);
    CHECK(observations * of_angles[cell] ==
          doctest::Approx(gonio::angular_error_penalty(small_prior(), pair, off.angular_error)));
    // The metric is logarithmic: its error is the relative error of the reading.
    const double value = gonio::reflectance_of(small_prior().metric(), small_prior().offset(cell), locations[cell]);
    const double reading = value * pair.wi.z() * pair.wo.z();
    CHECK(std::sqrt(of_dark[cell]) <= 1.5 * dark.dark_signal / reading);
  }
  CHECK(all_locations().size() == small_cells().size());
}

TEST_CASE("a dark signal is more of what grazes, on any number of threads") {
  gonio::design::apparatus dark;
  dark.dark_signal = 1e-3;
  const std::vector<gonio::location> two{gonio::locate(small_cells(), {0.1, gonio::radians(20), 0.1}),
                                         gonio::locate(small_cells(), {0.1, gonio::radians(75), 0.1})};
  const Eigen::VectorXd variances = gonio::design::reading_variances(dark, small_prior(), two);
  CHECK(variances[1] > 4.0 * variances[0]);
  const auto all = all_locations();
  CHECK(gonio::design::reading_variances(dark, small_prior(), all, {1}) ==
        gonio::design::reading_variances(dark, small_prior(), all, {3}));
}
