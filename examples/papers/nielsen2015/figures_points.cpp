/// Nielsen et al. 2015, Fig. 8 and 9, and Xu et al. 2016, Fig. 19: points and spheres.

#include "papers/experiments.hpp"
#include "papers/xu2016/figures.hpp"
#include "tool/files/json.hpp"
#include <gonio/core/random.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/image_candidates.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/design/sphere_geometry.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/model/fit_model.hpp>

#include <algorithm>

namespace papers::figures {

namespace {

using angles = std::vector<gonio::half_difference>;

/// Searches like Nielsen et al. 2015 from several seeds. Returns the directions with the lowest condition number.
angles by_condition(const laboratory& lab, const options& given, std::size_t n) {
  const gonio::design::point_geometry points(lab.prior().cells());
  const gonio::design::criterion_of_plan condition{lab.prior(), points, gonio::design::condition_number{}};
  gonio::design::capture_plan best;
  for (Eigen::Index r = 0; r < given.repetitions; ++r) {
    gonio::design::capture_plan plan = gonio::design::grow_and_descend(points, condition, n, 1, given.seed + r);
    if (plan.value < best.value || best.candidates.empty()) best = std::move(plan);
  }
  return samples_of(points, best.candidates);
}

/// Returns the best sets of 1 to `most` points by E.
std::vector<angles> points_by_expected_error(const laboratory& lab, const options& given, std::size_t most,
                                             const gonio::progress& listener) {
  const gonio::design::cell_candidates candidates(lab.prior(), criterion_of(lab, given), {}, given.threads);
  std::vector<angles> sets;
  for (const auto& plan : best_plans(candidates, most, 0, given.seed, listener))
    sets.push_back(samples_of(candidates.geometry(), plan.candidates));
  return sets;
}

/// Returns the best sets of 1 to `most` spheres by E.
std::vector<gonio::design::capture_plan> spheres_by_expected_error(const laboratory& lab, const options& given,
                                                                   std::size_t most, const gonio::progress& listener) {
  const gonio::design::image_candidates candidates(
      gonio::design::image_objective(lab.prior(), criterion_of(lab, given),
                                     gonio::design::sphere_geometry(lab.prior().cells())),
      given.threads, listener);
  return best_plans(candidates, most, most, given.seed, listener);
}

angles random_points(const laboratory& lab, std::size_t n, std::uint64_t seed) {
  angles directions;
  for (const Eigen::Index cell : gonio::random_cells(lab.prior().cells(), n, seed))
    directions.push_back(lab.prior().cells().angles(cell));
  return directions;
}

/// Returns the mean error over random sets of points or of slices.
template <class Draw>
double error_of_random(const laboratory& lab, const options& given, Draw&& draw) {
  double sum = 0.0;
  for (Eigen::Index r = 0; r < given.random_sets; ++r) sum += lab.error(draw(given.seed + r));
  return sum / static_cast<double>(given.random_sets);
}

/// Returns the error of n published points, if there are any.
json error_of_published(const laboratory& lab, std::size_t n) {
  if (!gonio::design::has_nielsen_directions(n)) return {};
  return lab.error(gonio::design::nielsen_directions(n));
}

table against_points(const laboratory& lab, const options& given, const gonio::progress& listener) {
  table shown{"Points: mean mapped error of the ten materials, and E, by number of measurements n",
              {{"n", 0},
               {"published"},
               {"condition"},
               {"expected error"},
               {"random"},
               {"E: condition", 4},
               {"E: expected error", 4}}};
  const auto best = points_by_expected_error(lab, given, given.up_to(20), listener);
  for (std::size_t n = 1; n <= best.size(); ++n) {
    gonio::report(listener, "points", static_cast<double>(n) / static_cast<double>(best.size()));
    const angles theirs = by_condition(lab, given, n);
    shown.rows.push_back({n, error_of_published(lab, n), lab.error(theirs), lab.error(best[n - 1]),
                          error_of_random(lab, given, [&](std::uint64_t seed) { return random_points(lab, n, seed); }),
                          expected_of(lab, given, theirs), expected_of(lab, given, best[n - 1])});
  }
  return shown;
}

table against_spheres(const laboratory& lab, const options& given, const gonio::progress& listener) {
  table shown{"Images of spheres: the same; published: Table 2 of 2015, of which the search was by condition number",
              {{"n", 0}, {"published"}, {"expected error"}, {"random"}, {"random / expected error", 2}}};
  const gonio::design::sphere_geometry spheres(lab.prior().cells());
  const auto plans = spheres_by_expected_error(lab, given, std::min<std::size_t>(given.up_to(5), 5), listener);
  for (const gonio::design::capture_plan& plan : plans) {
    const std::size_t n = plan.candidates.size();
    gonio::report(listener, "spheres", static_cast<double>(n) / static_cast<double>(plans.size()));
    const auto theirs = sphere_slices(spheres, "published", n);
    const double ours = lab.error(samples_of(spheres, plan.candidates));
    const double random = error_of_random(lab, given, [&](std::uint64_t seed) {
      return samples_of(spheres, gonio::random_choice(spheres.size(), n, seed));
    });
    shown.rows.push_back(
        {n, theirs.empty() ? json() : json(lab.error(samples_of(spheres, theirs))), ours, random, random / ours});
  }
  return shown;
}

/// Returns the bounds of the error: without any measurement, and with all measurements.
table bounds(const laboratory& lab) {
  return {"Bounds",
          {{"measured"}, {"mean mapped error"}},
          {{"nothing: the mean of the database", lab.tested.from_nothing().mean()},
           {"all: the projection", lab.tested.from_all().mean()}}};
}

/// Errors of one set of Fig. 8, one row per material.
struct named_errors {
  std::string name;
  Eigen::ArrayX3d errors;
};

/// Fits a Ward lobe and a Lambertian lobe to each material's measurements in the directions, under ln(1 + f).
Eigen::ArrayX3d fitted_ward(const laboratory& lab, const options& given, const angles& directions) {
  const std::vector kinds{&gonio::model::lobe_kind::of<gonio::model::lambert_shape>(),
                          &gonio::model::lobe_kind::of<gonio::model::ward_shape>()};
  std::vector<gonio::model::analytic_brdf> fits;
  for (std::size_t m = 0; m < lab.tested.names().size(); ++m) {
    const auto observations = gonio::model::fit_observations(lab.tested.measured(m, directions));
    fits.push_back(gonio::model::fit_model(kinds, observations, gonio::log(), {.random_starts = 20}).model);
  }
  return lab.tested.of(fits, given.threads);
}

std::vector<named_errors> five_directions(const laboratory& lab, const options& given,
                                          const gonio::progress& listener) {
  Eigen::ArrayX3d random = Eigen::ArrayX3d::Zero(std::ssize(lab.tested.names()), 3);
  for (Eigen::Index r = 0; r < given.random_sets; ++r)
    random += lab.tested.from(random_points(lab, 5, given.seed + r)) / static_cast<double>(given.random_sets);
  const angles expected = points_by_expected_error(lab, given, 5, listener).back();
  return {{"published", lab.tested.from(gonio::design::nielsen_directions(5))},
          {"condition", lab.tested.from(by_condition(lab, given, 5))},
          {"expected error", lab.tested.from(expected)},
          {"industry", lab.tested.from(gonio::design::westlund_meyer_directions())},
          {"random", std::move(random)},
          {"Ward, published", fitted_ward(lab, given, gonio::design::nielsen_directions(5))},
          {"Ward, expected error", fitted_ward(lab, given, expected)},
          {"all", lab.tested.from_all()},
          {"nothing", lab.tested.from_nothing()}};
}

}  // namespace

tables nielsen_8(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const auto sets = five_directions(lab, given, listener);
  table errors{"Mapped error from five directions, mean over the channels", {{"material"}}};
  for (const named_errors& set : sets) errors.columns.push_back({set.name});
  for (Eigen::Index m = 0; m < std::ssize(lab.tested.names()); ++m) {
    auto& row = errors.rows.emplace_back();
    row.emplace_back(lab.tested.names()[m]);
    for (const named_errors& set : sets) row.emplace_back(set.errors.row(m).mean());
  }
  auto& mean = errors.rows.emplace_back();
  mean.emplace_back("mean");
  for (const named_errors& set : sets) mean.emplace_back(set.errors.mean());

  table ratios{"Industry's five over others, of 30 channels; printed: up to an order of magnitude",
               {{"against"}, {"smallest", 2}, {"median", 2}, {"largest", 2}}};
  for (std::size_t s = 0; s < 3; ++s) {
    const Eigen::ArrayX3d ratio = sets[3].errors / sets[s].errors;
    std::vector<double> sorted(ratio.data(), ratio.data() + ratio.size());
    std::ranges::sort(sorted);
    ratios.rows.push_back({sets[s].name, sorted.front(), sorted[sorted.size() / 2], sorted.back()});
  }
  return {std::move(errors), std::move(ratios)};
}

tables nielsen_9(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  return {against_points(lab, given, listener), against_spheres(lab, given, listener), bounds(lab)};
}

tables xu_19(const options& given, const gonio::progress& listener) {
  // The curves are from 2015; Xu et al. compare two of them. Count the points that one criterion saves.
  const laboratory lab = open_laboratory(given, listener);
  const table points = against_points(lab, given, listener);
  table saved{
      "The fewest points by condition number that reach the error of points by expected error (printed: 20 for 5)",
      {{"by expected error", 0}, {"error"}, {"by condition number", 0}}};
  for (const auto& row : points.rows) {
    const auto reached =
        std::ranges::find_if(points.rows, [&](const auto& other) { return other[2].number() <= row[3].number(); });
    saved.rows.push_back({row[0], row[3], reached == points.rows.end() ? json("not reached") : (*reached)[0]});
  }
  table steps{"Does the error fall with each further point?", {{"criterion"}, {"steps", 0}, {"of which it rises", 0}}};
  for (const Eigen::Index column : {Eigen::Index{2}, Eigen::Index{3}}) {
    std::size_t rises = 0;
    for (std::size_t i = 1; i < points.rows.size(); ++i)
      if (points.rows[i][column].number() > points.rows[i - 1][column].number()) ++rises;
    steps.rows.push_back({points.columns[column].title, points.rows.size() - 1, rises});
  }
  return {points, against_spheres(lab, given, listener), std::move(saved), std::move(steps), bounds(lab)};
}

}  // namespace papers::figures
