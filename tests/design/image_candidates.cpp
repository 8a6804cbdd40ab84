#include "synthetic_candidates.hpp"
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/design/image_candidates.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/design/sphere_geometry.hpp>

#include <doctest/doctest.h>

namespace {

using gonio::design::expected_error;
using gonio::design::near_field_geometry;
using gonio::design::sphere_geometry;

static_assert(gonio::design::sweeping_objective<gonio::design::image_candidates<gonio::log_relative, sphere_geometry>>);

constexpr gonio::design::expected_error_options with_noise{.eta = 0.5, .noise = 0.1, .common_shift = 0.3};

/// Returns E of all samples of some images, with one row for each sample.
template <class Geometry>
double of_all_samples(const Geometry& geometry, const std::vector<Eigen::Index>& images) {
  std::vector<Eigen::RowVectorXd> rows;
  for (const Eigen::Index image : images)
    for (const auto& angles : geometry.directions(image)) {
      const auto& grid = small_cells().grid();
      const Eigen::Index cell = small_cells().representative(grid.linear(grid.nearest(angles)));
      rows.push_back(candidate_basis().components().row(cell).cast<double>());
    }
  Eigen::MatrixXd all(std::ssize(rows), std::ssize(candidate_basis()));
  for (Eigen::Index i = 0; i < std::ssize(rows); ++i) all.row(i) = rows[i];
  return expected_error(candidate_basis(), with_noise)(all);
}

near_field_geometry coarse_near_field() {
  return near_field_geometry({.pixels = 8, .step = gonio::radians(20), .largest_polar_angle = gonio::radians(80)});
}

template <class Geometry>
auto objective_of(const Geometry& geometry) {
  return gonio::design::image_objective(candidate_basis(), expected_error(candidate_basis(), with_noise), geometry);
}

}  // namespace

TEST_CASE("compressed images are worth what all of their samples are") {
  const sphere_geometry spheres(small_cells());
  for (const std::vector<Eigen::Index>& images : {std::vector<Eigen::Index>{0}, {3}, {1, 5}, {0, 2, 6}})
    CHECK(objective_of(spheres)(images) == doctest::Approx(of_all_samples(spheres, images)).epsilon(2e-3));
  const auto near_field = coarse_near_field();
  for (const std::vector<Eigen::Index>& images : {std::vector<Eigen::Index>{45}, {30, 170}})
    CHECK(objective_of(near_field)(images) == doctest::Approx(of_all_samples(near_field, images)).epsilon(2e-3));
}

TEST_CASE("prepared images, images beside others and sweeps agree") {
  const auto objective = objective_of(coarse_near_field());
  const gonio::design::image_candidates prepared(objective);
  const std::vector<Eigen::Index> two{30, 170};
  CHECK(prepared(two) == doctest::Approx(objective(two)).epsilon(1e-12));
  const auto errors = prepared.errors_with_each(two);
  const auto with = objective.beside(two);
  for (Eigen::Index candidate = 0; candidate < std::ssize(errors); candidate += 7) {
    if (!objective.geometry().allows(candidate)) {
      CHECK(std::isinf(errors[candidate]));
      continue;
    }
    CHECK(double{errors[candidate]} == doctest::Approx(with(candidate)).epsilon(1e-6));
    CHECK(with(candidate) == doctest::Approx(objective(std::vector<Eigen::Index>{30, 170, candidate})).epsilon(1e-12));
  }
  CHECK(errors == gonio::design::image_candidates(objective, {1}).errors_with_each(two));
  const auto last = prepared.errors_with_each(two, {50, std::ssize(errors)});
  CHECK(std::ranges::equal(last, std::span(errors).subspan(50)));
}

TEST_CASE("two images: exchange comes to the best pair of all") {
  const gonio::design::image_candidates spheres(objective_of(sphere_geometry(small_cells())));
  double best = 1e9;
  for (Eigen::Index a = 0; a < 7; ++a)
    for (Eigen::Index b = a + 1; b < 7; ++b) best = std::min(best, spheres(std::vector<Eigen::Index>{a, b}));
  double found = 1e9;
  for (Eigen::Index first = 0; first < 7; ++first)
    found = std::min(found, gonio::design::exchange(spheres, {{first, (first + 3) % 7}}).value);
  CHECK(found == doctest::Approx(best).epsilon(1e-6));
  const auto slid = gonio::design::descend(spheres.geometry(), spheres, gonio::design::grow_greedily(spheres, 2));
  CHECK(slid.value >= best * (1.0 - 1e-9));
}

TEST_CASE("an image is worth more than its centre") {
  const auto near_field = coarse_near_field();
  const expected_error criterion(candidate_basis(), {.eta = 0.5});
  const gonio::design::image_objective objective(candidate_basis(), criterion, near_field);
  for (const Eigen::Index image : {Eigen::Index{45}, Eigen::Index{88}}) {
    const std::vector<gonio::half_difference> centre{
        gonio::to_half_difference(near_field.centre(image).wi, near_field.centre(image).wo)};
    CHECK(objective(std::vector<Eigen::Index>{image}) <
          criterion(gonio::design::rows_at(candidate_basis(), centre).components));
  }
}
