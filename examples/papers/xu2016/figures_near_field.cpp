/// Xu et al. 2016, Fig. 3, 5 to 8 and 13: close-up images of a flat sample.

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/nielsen2015/gradient_descent.hpp"
#include "papers/xu2016/figures.hpp"
#include "tool/files/json.hpp"
#include "tool/options/chosen_networks.hpp"
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/image_candidates.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/evaluate/test_materials.hpp>

#include <algorithm>
#include <limits>
#include <random>

namespace papers::figures {

namespace {

using images = gonio::design::image_candidates<gonio::log_relative, gonio::design::near_field_geometry>;

/// Exchanging more images than this would take minutes.
constexpr std::size_t most_exchanged = 2;

gonio::design::near_field_geometry geometry_of(double field_of_view, double step) {
  return gonio::design::near_field_geometry(
      {.field_of_view = gonio::radians(field_of_view), .step = gonio::radians(step)});
}

images read_images(const laboratory& lab, const options& given, double field_of_view, const gonio::progress& listener) {
  return images(
      gonio::design::image_objective(lab.prior(), criterion_of(lab, given), geometry_of(field_of_view, given.step)),
      given.threads, listener);
}

/// Returns the best plans of 1 to `most` images on the coarse grid, moved to the best ones on a grid of one degree.
std::vector<gonio::design::capture_plan> refined_plans(const laboratory& lab, const options& given,
                                                       const images& coarse, std::size_t most,
                                                       const gonio::progress& listener) {
  const gonio::design::image_objective fine(
      lab.prior(), criterion_of(lab, given),
      geometry_of(gonio::degrees(coarse.geometry().options().field_of_view), 1.0));
  auto plans = best_plans(coarse, most, most_exchanged, given.seed, listener);
  for (gonio::design::capture_plan& plan : plans) {
    gonio::report(listener, "sliding", static_cast<double>(plan.candidates.size()) / static_cast<double>(most));
    for (Eigen::Index& candidate : plan.candidates)
      candidate = fine.geometry().nearest(coarse.geometry().centre(candidate));
    plan = gonio::design::descend(fine.geometry(), fine, std::move(plan), given.seed);
  }
  return plans;
}

std::vector<json> errors_of(const laboratory& lab, const gonio::design::near_field_geometry& geometry,
                            const std::vector<gonio::design::capture_plan>& plans) {
  std::vector<json> errors;
  for (const auto& plan : plans) errors.emplace_back(lab.error(samples_of(geometry, plan.candidates)));
  return errors;
}

/// Errors of points for comparison: of the published sets, and of our sets by expected error.
struct point_errors {
  std::vector<json> published, expected;
};

point_errors errors_of_points(const laboratory& lab, const options& given, std::size_t most,
                              const gonio::progress& listener) {
  const gonio::design::cell_candidates candidates(lab.prior(), criterion_of(lab, given), {}, given.threads);
  point_errors errors;
  for (const auto& plan : best_plans(candidates, most, 0, given.seed, listener)) {
    const std::size_t n = plan.candidates.size();
    errors.published.push_back(
        gonio::design::has_nielsen_directions(n) ? json(lab.error(gonio::design::nielsen_directions(n))) : json());
    errors.expected.emplace_back(lab.error(samples_of(candidates.geometry(), plan.candidates)));
  }
  return errors;
}

/// Puts titled columns side by side, one row per number of measurements. Short columns end in empty cells.
table side_by_side(const std::string& title, const std::vector<std::pair<std::string, std::vector<json>>>& columns) {
  table shown{title, {{"n", 0}}};
  std::size_t longest = 0;
  for (const auto& [name, values] : columns) {
    shown.columns.push_back({name});
    longest = std::max(longest, values.size());
  }
  for (std::size_t i = 0; i < longest; ++i) {
    auto& row = shown.rows.emplace_back();
    row.emplace_back(i + 1);
    for (const auto& [name, values] : columns) row.push_back(i < values.size() ? values[i] : json());
  }
  return shown;
}

std::string degrees_of(double field_of_view) { return std::to_string(std::lround(field_of_view)) + " degrees"; }

/// Tabulates the number of points that reach the error of images.
table points_for_images(const std::vector<std::pair<std::string, std::vector<json>>>& series,
                        const point_errors& points) {
  table shown{"The fewest points that reach the error of images; of the published ones there are 1, 2, 5, 10, 20",
              {{"field of view"}, {"images", 0}, {"error"}, {"published points", 0}, {"points by expected error", 0}}};
  const auto fewest = [](const std::vector<json>& errors, double wanted) -> json {
    for (std::size_t i = 0; i < errors.size(); ++i)
      if (!errors[i].is_null() && errors[i].number() <= wanted) return i + 1;
    return "more than " + std::to_string(errors.size());
  };
  for (const auto& [name, errors] : series)
    for (std::size_t i = 0; i < std::min<std::size_t>(errors.size(), 2); ++i)
      shown.rows.push_back({name, i + 1, errors[i], fewest(points.published, errors[i].number()),
                            fewest(points.expected, errors[i].number())});
  return shown;
}

/// Returns half and difference angles of the images of a plan in degrees, as in the paper's tables.
std::vector<std::vector<json>> printed_angles(const std::string& name,
                                              const gonio::design::near_field_geometry& geometry,
                                              const std::vector<Eigen::Index>& candidates) {
  std::vector<std::vector<json>> rows;
  for (const Eigen::Index candidate : candidates) {
    const auto [wi, wo] = geometry.centre(candidate);
    const gonio::half_difference at = gonio::to_half_difference(wi, wo);
    rows.push_back({name, candidates.size(), gonio::degrees(at.theta_h), gonio::degrees(at.theta_d),
                    gonio::degrees(at.phi_d), gonio::degrees(gonio::polar_angle(wi)),
                    gonio::degrees(gonio::polar_angle(wo))});
  }
  return rows;
}

table table_of_angles() {
  return {"Where light and camera are, in degrees",
          {{"set"},
           {"images", 0},
           {"theta_h", 0},
           {"theta_d", 0},
           {"phi_d", 0},
           {"light's polar angle", 0},
           {"camera's polar angle", 0}}};
}

/// Restricts images to a fixed polar angle of light or camera.
class with_one_fixed {
 public:
  with_one_fixed(const images& all, gonio::direction gonio::direction_pair::*fixed, double polar_angle)
      : all_(all), fixed_(fixed), polar_angle_(polar_angle) {}

  [[nodiscard]] const gonio::design::near_field_geometry& geometry() const noexcept { return all_.geometry(); }
  [[nodiscard]] double operator()(std::span<const Eigen::Index> candidates) const {
    return std::ranges::all_of(candidates, [&](std::size_t c) { return is_at_angle(c); })
               ? all_(candidates)
               : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> candidates) const {
    std::vector<float> errors(geometry().size(), std::numeric_limits<float>::infinity());
    const auto with = all_.beside(candidates);
    for (std::size_t candidate = 0; candidate < errors.size(); ++candidate)
      if (geometry().allows(candidate) && is_at_angle(candidate))
        errors[candidate] = static_cast<float>(with(candidate));
    return errors;
  }

 private:
  [[nodiscard]] bool is_at_angle(std::size_t candidate) const {
    return std::abs(gonio::polar_angle(geometry().centre(candidate).*fixed_) - polar_angle_) < 1e-6;
  }

  const images& all_;
  gonio::direction gonio::direction_pair::*fixed_;
  double polar_angle_;
};

/// Returns for each number of images the best plan over all fixed polar angles.
std::vector<gonio::design::capture_plan> plans_with_one_fixed(const images& all, const options& given, std::size_t most,
                                                              gonio::direction gonio::direction_pair::*fixed,
                                                              const gonio::progress& listener) {
  std::vector<gonio::design::capture_plan> best(most);
  const double step = gonio::radians(given.step), largest = all.geometry().options().largest_polar_angle;
  for (double polar_angle = 0.0; polar_angle <= largest + 1e-9; polar_angle += step) {
    gonio::report(listener, "fixed at " + std::to_string(std::lround(gonio::degrees(polar_angle))),
                  polar_angle / largest);
    const with_one_fixed objective(all, fixed, polar_angle);
    auto plans = best_plans(objective, most, most_exchanged, given.seed, {});
    for (std::size_t i = 0; i < most; ++i)
      if (plans[i].value < best[i].value) best[i] = std::move(plans[i]);
  }
  return best;
}

void add_angles(table& angles, const std::string& name, const gonio::design::near_field_geometry& geometry,
                const gonio::design::capture_plan& plan) {
  const auto rows = printed_angles(name, geometry, plan.candidates);
  angles.rows.insert(angles.rows.end(), rows.begin(), rows.end());
}

}  // namespace

tables xu_3(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const std::vector<std::pair<std::string, std::vector<gonio::half_difference>>> sets{
      {"one image", samples_of_images(shipped_poses("near-field-25-1-expected-error"))},
      {"two images", samples_of_images(shipped_poses("near-field-25-2-expected-error"))},
      {"5 points, published", gonio::design::nielsen_directions(5)},
      {"20 points, published", gonio::design::nielsen_directions(20)}};
  const Eigen::ArrayX3d deviation = lab.tested.from_all();
  table shown{"E_deviation and E_recon, root mean square over the cells, mean over the channels",
              {{"material"}, {"E_deviation"}}};
  std::vector<Eigen::ArrayX3d> missed;
  for (const auto& [name, directions] : sets) {
    shown.columns.push_back({"E_recon, " + name});
    // The projection is orthogonal to its residual, so the squares of both errors add.
    missed.push_back((lab.tested.from(directions).square() - deviation.square()).max(0.0).sqrt());
  }
  for (Eigen::Index m = 0; m < deviation.rows(); ++m) {
    auto& row = shown.rows.emplace_back(std::vector<json>{lab.tested.names()[m], deviation.row(m).mean()});
    for (const Eigen::ArrayX3d& of_set : missed) row.emplace_back(of_set.row(m).mean());
  }
  auto& mean = shown.rows.emplace_back(std::vector<json>{"mean", deviation.mean()});
  for (const Eigen::ArrayX3d& of_set : missed) mean.emplace_back(of_set.mean());
  return {std::move(shown)};
}

tables xu_5(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const std::size_t most = given.up_to(5);
  std::vector<std::pair<std::string, std::vector<json>>> errors, conditions;
  for (const double field_of_view : given.fields_of_view) {
    const std::string name = degrees_of(field_of_view);
    const images all = read_images(lab, given, field_of_view, listener);
    const gonio::design::near_field_geometry fine = geometry_of(field_of_view, 1.0);
    errors.emplace_back(name + ", expected error",
                        errors_of(lab, fine, refined_plans(lab, given, all, most, listener)));
    const gonio::design::criterion_of_plan condition{lab.prior(), fine, gonio::design::condition_number{}};
    const auto theirs = grown_plans(
        fine, most, given.seed,
        [&](gonio::design::capture_plan plan, std::uint64_t order) {
          return gonio::design::descend(fine, condition, std::move(plan), order);
        },
        listener);
    std::vector<json> reached;
    for (const gonio::design::capture_plan& plan : theirs) reached.emplace_back(plan.value);
    errors.emplace_back(name + ", condition", errors_of(lab, fine, theirs));
    conditions.emplace_back(name, std::move(reached));
  }
  return {side_by_side("Mean mapped error of the ten materials by number of images n", errors),
          side_by_side("The condition number that its search reached", conditions)};
}

tables xu_6(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const point_errors points = errors_of_points(lab, given, given.up_to(20), listener);
  std::vector<std::pair<std::string, std::vector<json>>> series;
  table angles = table_of_angles();
  for (const double field_of_view : given.fields_of_view) {
    const images all = read_images(lab, given, field_of_view, listener);
    const gonio::design::near_field_geometry fine = geometry_of(field_of_view, 1.0);
    const auto plans = refined_plans(lab, given, all, std::min<std::size_t>(given.up_to(5), 5), listener);
    series.emplace_back(degrees_of(field_of_view), errors_of(lab, fine, plans));
    for (std::size_t i = 0; i < std::min<std::size_t>(plans.size(), 2); ++i)
      add_angles(angles, degrees_of(field_of_view), fine, plans[i]);
  }
  table reached = points_for_images(series, points);
  series.emplace_back("points, published", points.published);
  series.emplace_back("points, expected error", points.expected);
  return {side_by_side("Mean mapped error of the ten materials by number n of images, or of points", series),
          std::move(reached), std::move(angles)};
}

tables xu_7(const options& given, const gonio::progress& listener) {
  auto learned = networks_except(given.networks.read(), gonio::nielsen_test_materials(), given.networks.file);
  // Shuffle the materials; each row learns the first ones.
  std::vector<std::string> order = learned.names;
  std::mt19937_64 generator(given.seed);
  std::ranges::shuffle(order, generator);
  table shown{"Two images at 25 degrees by number of materials learned",
              {{"materials", 0}, {"components", 0}, {"mapped error"}, {"projection: mapped error"}}};
  const Eigen::Index largest = given.most > 0 ? std::min(given.most, std::ssize(order)) : std::ssize(order);
  const Eigen::Index step = std::min<Eigen::Index>(largest, 10);
  for (Eigen::Index count = step; count <= largest; count += step) {
    const std::vector<std::string> names(order.begin(), order.begin() + count);
    const laboratory lab = open_laboratory(given, networks_in(learned, names, given.networks.file), listener);
    const images all = read_images(lab, given, figures_field_of_view, listener);
    const auto plans = refined_plans(lab, given, all, 2, listener);
    const gonio::design::near_field_geometry fine = geometry_of(figures_field_of_view, 1.0);
    shown.rows.push_back({count, lab.prior().size(), lab.error(samples_of(fine, plans.back().candidates)),
                          lab.tested.from_all().mean()});
  }
  return {std::move(shown)};
}

tables xu_8(const options& given, const gonio::progress& listener) {
  // Learn all materials, because these directions, like the paper's, are for materials that nobody has measured.
  const laboratory lab = open_laboratory(given, given.networks.read(), listener);
  table angles = table_of_angles();
  table worth{"E, root mean square over the cells, mean over all materials learned",
              {{"field of view"}, {"one image", 4}, {"two images", 4}}};
  for (const double field_of_view : given.fields_of_view) {
    const std::string name = degrees_of(field_of_view);
    const images all = read_images(lab, given, field_of_view, listener);
    const auto plans = refined_plans(lab, given, all, 2, listener);
    for (const auto& plan : plans) add_angles(angles, name, geometry_of(field_of_view, 1.0), plan);
    worth.rows.push_back({name, lab.expected(plans[0].value), lab.expected(plans[1].value)});
  }
  return {std::move(angles), std::move(worth)};
}

tables xu_13(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const std::size_t most = given.up_to(5);
  const images all = read_images(lab, given, figures_field_of_view, listener);
  const auto free = best_plans(all, most, most_exchanged, given.seed, listener);
  const auto camera = plans_with_one_fixed(all, given, most, &gonio::direction_pair::wo, listener);
  const auto light = plans_with_one_fixed(all, given, most, &gonio::direction_pair::wi, listener);
  const point_errors points = errors_of_points(lab, given, most, listener);

  table angles = table_of_angles();
  for (const auto& [name, plans] : {std::pair{"free", &free}, {"fixed camera", &camera}, {"fixed light", &light}})
    add_angles(angles, name, all.geometry(), (*plans)[std::min<std::size_t>(most, 2) - 1]);
  table printed{"Two images as printed (Fig. 14: theta_h, theta_d, phi_d 4 63 90, and 39 34 124 or 39 33 126)",
                {{"set"}, {"mapped error"}},
                {{"fixed camera (Fig. 14 a)", lab.error(samples_of_images(printed_fixed_camera()))},
                 {"fixed light (Fig. 14 b)", lab.error(samples_of_images(printed_fixed_light()))}}};
  return {side_by_side("Mean mapped error of the ten materials by number n of images at 25 degrees, or of points",
                       {{"free", errors_of(lab, all.geometry(), free)},
                        {"fixed camera", errors_of(lab, all.geometry(), camera)},
                        {"fixed light", errors_of(lab, all.geometry(), light)},
                        {"points, published", points.published},
                        {"points, expected error", points.expected}}),
          std::move(angles), std::move(printed)};
}

}  // namespace papers::figures
