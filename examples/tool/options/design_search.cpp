#include "design_search.hpp"

#include <gonio/basis/pca.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/design/image_candidates.hpp>
#include <gonio/design/reading_variances.hpp>
#include <gonio/design/sphere_geometry.hpp>
#include <gonio/evaluate/perceived_candidates.hpp>
#include <gonio/evaluate/perceived_norm.hpp>

namespace cli {

namespace {

using gonio::design::capture_plan;
using prior_t = gonio::log_relative_pca;

/// Xu et al. 2016, section 5.1.
constexpr std::size_t random_candidates = 500;

gonio::design::expected_error_options expectation_of(const design_options& options) {
  return {.eta = options.eta,
          .noise = options.apparatus.noise,
          .common_shift = options.common_shift,
          .leave_out = !options.in_sample};
}

gonio::design::expected_error expected_error_of(const prior_t& prior, const design_options& options) {
  return gonio::design::expected_error(prior, expectation_of(options));
}

/// Returns the criterion that a search minimises.
gonio::design::expected_error criterion_of(const prior_t& prior, const design_options& options) {
  if (options.criterion == "expected-error") return expected_error_of(prior, options);
  return gonio::design::expected_error(prior, expectation_of(options), gonio::perceived_norm(prior, options.threads));
}

gonio::design::near_field_options near_field_of(const design_options& options) {
  gonio::design::near_field_options setup = options.near_field;
  setup.constraint = options.apparatus.constraint;
  return setup;
}

gonio::design::point_geometry points_of(const prior_t& prior, const design_options& options) {
  return gonio::design::point_geometry(prior.cells(), options.apparatus.constraint);
}

gonio::design::sphere_geometry spheres_of(const prior_t& prior, const design_options& options) {
  return gonio::design::sphere_geometry(prior.cells(), options.apparatus.constraint.smallest_separation);
}

template <class Geometry>
capture_plan start_of(const Geometry& geometry, const design_options& options) {
  capture_plan plan;
  for (const gonio::direction_pair& pair : options.start) plan.candidates.push_back(geometry.nearest(pair));
  return plan;
}

/// The processes that share the sweeps of a search, and the record of the sweeps (may be null).
struct sweeping {
  const team& processes;
  sweep_record* record;
};

/// An objective for several processes, which share each sweep. Recorded sweeps are not repeated.
template <gonio::design::sweeping_objective Objective>
class shared_sweeps {
 public:
  /// Both arguments must outlive this object.
  shared_sweeps(const Objective& whole, const sweeping& how) : whole_(whole), how_(how) {}

  [[nodiscard]] const auto& geometry() const noexcept { return whole_.geometry(); }
  [[nodiscard]] double operator()(std::span<const Eigen::Index> candidates) const { return whole_(candidates); }
  [[nodiscard]] auto beside(std::span<const Eigen::Index> candidates) const { return whole_.beside(candidates); }
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> candidates) const {
    return whole_.errors_with_each(candidates);
  }

  [[nodiscard]] Eigen::Index best_beside(std::span<const Eigen::Index> candidates) const {
    const auto sweep = [&] { return best_of_sweep(candidates); };
    return how_.record ? how_.record->next(sweep, geometry().size()) : sweep();
  }

 private:
  [[nodiscard]] Eigen::Index best_of_sweep(std::span<const Eigen::Index> candidates) const {
    const gonio::block share = how_.processes.share_of(geometry().size(), Objective::sweep_block);
    std::vector<float> errors = whole_.errors_with_each(candidates, share);
    errors.push_back(std::numeric_limits<float>::infinity());  // a share may have no candidate
    for (const Eigen::Index candidate : candidates)
      if (candidate >= share.begin && candidate < share.end) errors[candidate - share.begin] = errors.back();
    const auto best = std::ranges::min_element(errors);
    return how_.processes.best(double{*best}, share.begin + (best - errors.begin()));
  }

  const Objective& whole_;
  sweeping how_;
};

/// Searches by sweeps over all candidates.
template <gonio::design::sweeping_objective Objective>
capture_plan sweep(const Objective& whole, const design_options& options, const gonio::progress& listener,
                   const sweeping& how) {
  const shared_sweeps objective(whole, how);
  const capture_plan start = start_of(objective.geometry(), options);
  const capture_plan greedy = gonio::design::grow_greedily(objective, options.count, start, listener);
  if (options.search == "greedy" || !start.candidates.empty()) return greedy;
  return gonio::design::exchange(objective, greedy, listener);
}

/// Searches by descent, from random candidates.
template <class Objective>
capture_plan slide(const Objective& objective, const design_options& options, const gonio::progress& listener) {
  if (!options.start.empty())
    gonio::refuse("--start needs --criterion expected-error or perceived, and --search greedy or exchange");
  return gonio::design::grow_and_descend(objective.geometry(), objective, options.count, random_candidates,
                                         options.seed, listener);
}

template <class Geometry>
designed finished(const Geometry& geometry, const capture_plan& plan) {
  designed found;
  found.value = plan.value;
  for (const Eigen::Index candidate : plan.candidates) {
    found.poses.push_back(geometry.centre(candidate));
    const auto samples = geometry.directions(candidate);
    found.samples.insert(found.samples.end(), samples.begin(), samples.end());
  }
  return found;
}

/// Searches as the options state.
template <gonio::design::sweeping_objective Objective>
capture_plan search(const Objective& objective, const design_options& options, const gonio::progress& listener,
                    const sweeping& how) {
  return options.search == "descent" ? slide(objective, options, listener) : sweep(objective, options, listener, how);
}

/// Returns a penalty for each cell: the dark signal and angular errors, which the criterion does not include.
std::vector<double> sample_noise_penalties(const prior_t& prior, const design_options& options) {
  gonio::design::apparatus other = options.apparatus;
  other.noise = 0.0;
  if (other.dark_signal == 0.0 && other.angular_error == 0.0) return {};
  std::vector<gonio::location> locations;
  for (Eigen::Index cell = 0; cell < prior.cells().size(); ++cell)
    locations.push_back(gonio::locate_cell(prior.cells(), cell));
  const Eigen::VectorXd penalties =
      gonio::design::reading_variances(other, prior, locations, options.threads) * prior.coefficients().rows();
  return {penalties.begin(), penalties.end()};
}

/// Chooses samples by the visible error of the reconstruction that `gonio reconstruct` makes from them.
designed by_perception(const prior_t& prior, const design_options& options, const gonio::progress& listener,
                       const sweeping& how) {
  const gonio::reconstruction estimator(prior, {.noise = options.apparatus.noise}, options.threads);
  const gonio::perceived_candidates candidates(gonio::design::sequential_design(estimator, options.apparatus), {},
                                               options.threads);
  return finished(candidates.geometry(), search(candidates, options, listener, how));
}

template <class Geometry>
designed by_expected_error(const prior_t& prior, const Geometry& geometry, const design_options& options,
                           const gonio::progress& listener, const sweeping& how) {
  gonio::design::expected_error criterion = criterion_of(prior, options);
  if constexpr (std::is_same_v<Geometry, gonio::design::point_geometry>) {
    const gonio::design::cell_candidates candidates(prior, std::move(criterion), options.apparatus.constraint,
                                                    options.threads, sample_noise_penalties(prior, options));
    return finished(geometry, search(candidates, options, listener, how));
  } else {
    gonio::design::image_objective objective(prior, std::move(criterion), geometry);
    if (options.search == "descent") return finished(geometry, slide(objective, options, listener));
    const gonio::design::image_candidates candidates(std::move(objective), options.threads, listener);
    return finished(geometry, search(candidates, options, listener, how));
  }
}

template <class Geometry>
designed with(const prior_t& prior, const Geometry& geometry, const design_options& options,
              const gonio::progress& listener, const sweeping& how) {
  const auto by = [&](auto criterion) {
    return finished(geometry, slide(gonio::design::criterion_of_plan{prior, geometry, criterion}, options, listener));
  };
  if (options.criterion == "condition") return by(gonio::design::condition_number{});
  // Independent noise has the effect of a larger eta.
  const double eta = options.eta + expected_error_of(prior, options).noise_eta();
  if (options.criterion == "d-optimal") return by(gonio::design::d_optimality(eta));
  if (options.criterion == "a-optimal")
    return by(gonio::design::a_optimality(prior.singular_values().cwiseAbs2(), eta));
  return by_expected_error(prior, geometry, options, listener, how);
}

/// Returns the best design over all fixed cameras (or lights), each with its own best lights (or cameras).
designed with_one_fixed(const prior_t& prior, const design_options& options,
                        std::optional<double> gonio::design::near_field_options::*fixed,
                        const gonio::progress& listener, const sweeping& how) {
  designed best;
  best.value = std::numeric_limits<double>::infinity();
  const gonio::design::near_field_options setup = near_field_of(options);
  for (double theta = 0.0; theta <= setup.largest_polar_angle + 1e-9; theta += setup.step) {
    const gonio::design::capture_constraint& can = setup.constraint;
    if (!(fixed == &gonio::design::near_field_options::fixed_camera ? can.viewer : can.light).contains(theta)) continue;
    gonio::report(listener, "fixed at " + std::to_string(std::lround(gonio::degrees(theta))),
                  theta / setup.largest_polar_angle);
    gonio::design::near_field_options here = setup;
    here.*fixed = theta;
    designed found = with(prior, gonio::design::near_field_geometry(here), options, listener, how);
    if (found.value < best.value) best = std::move(found);
  }
  return best;
}

/// Gives the points of --start their own directions again; the search moved them to the nearest candidates.
designed keeping_start(designed found, const design_options& options) {
  for (std::size_t i = 0; i < options.start.size(); ++i) {
    found.poses[i] = options.start[i];
    found.samples[i] = gonio::to_half_difference(options.start[i].wi, options.start[i].wo);
  }
  return found;
}

/// Refuses options that the criterion does not support.
void require_criterion(const design_options& options) {
  const bool expects_errors = options.criterion == "expected-error" || options.criterion.starts_with("perceived");
  const double angular_error = options.apparatus.angular_error;
  if (!(angular_error >= 0.0 && angular_error < gonio::radians(45.0)))
    gonio::refuse("--misplaced needs an angle from 0 to 45 degrees, not " +
                  std::to_string(gonio::degrees(angular_error)));
  if (angular_error != 0.0 && !(options.geometry == "point" && expects_errors))
    gonio::refuse("--misplaced needs --geometry point and --criterion expected-error or perceived");
  const bool is_reconstruction = options.geometry == "point" && options.criterion == "perceived";
  if ((!expects_errors || is_reconstruction) && (options.common_shift != 0.0 || options.in_sample))
    gonio::refuse("--common-shift and --in-sample need --criterion expected-error" +
                  std::string(is_reconstruction ? ", not perceived" : " or perceived, not " + options.criterion));
  if (is_reconstruction && options.eta != gonio::default_eta)
    gonio::refuse("--eta needs --criterion expected-error, not perceived");
}

}  // namespace

designed design(const gonio::log_relative_pca& prior, const design_options& options, const gonio::progress& listener,
                const team& processes, sweep_record* record) {
  const sweeping how{processes, record};
  require_criterion(options);
  if (options.geometry == "point")
    return keeping_start(options.criterion == "perceived"
                             ? by_perception(prior, options, listener, how)
                             : with(prior, points_of(prior, options), options, listener, how),
                         options);
  if (options.geometry == "sphere") return with(prior, spheres_of(prior, options), options, listener, how);
  if (options.geometry == "fixed-camera")
    return with_one_fixed(prior, options, &gonio::design::near_field_options::fixed_camera, listener, how);
  if (options.geometry == "fixed-light")
    return with_one_fixed(prior, options, &gonio::design::near_field_options::fixed_light, listener, how);
  return with(prior, gonio::design::near_field_geometry(near_field_of(options)), options, listener, how);
}

designed placed(const gonio::log_relative_pca& prior, const design_options& options,
                const std::vector<gonio::direction_pair>& poses) {
  const auto at = [&](const auto& geometry) {
    capture_plan plan;
    for (const gonio::direction_pair& pair : poses) plan.candidates.push_back(geometry.nearest(pair));
    return finished(geometry, plan);
  };
  if (options.geometry == "point") return at(points_of(prior, options));
  if (options.geometry == "sphere") return at(spheres_of(prior, options));
  return at(gonio::design::near_field_geometry(near_field_of(options)));
}

design_quality quality_of(const gonio::log_relative_pca& prior, const design_options& options, const designed& found) {
  const gonio::design::expected_error criterion = expected_error_of(prior, options);
  const auto few = gonio::design::compressed(gonio::design::rows_at(prior, found.samples), 1e-3 * options.eta);
  const double error = criterion(criterion.prepare(few.components, few.noise));
  const double nothing = criterion(gonio::design::expected_error::rows(0, criterion.coefficients().rows()));
  // A prior may keep fewer cells than it was learned on; its singular values are of all learned cells.
  const double kept = prior.components().cast<double>().squaredNorm() / prior.singular_values().squaredNorm();
  return {error * std::sqrt(kept / static_cast<double>(prior.cells().size())), error / nothing};
}

}  // namespace cli
