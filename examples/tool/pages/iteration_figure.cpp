#include "iteration_figure.hpp"

#include "figure_tiles.hpp"
#include "fixed.hpp"
#include <gonio/estimate/fitted_brdf.hpp>

#include <string>

namespace cli {

iteration_figure::iteration_figure(gonio::correction corrections, gonio::sample_set samples,
                                   std::optional<gonio::brdf_table> truth, gonio::thread_count threads)
    : corrections_(std::move(corrections)), samples_(std::move(samples)), truth_(std::move(truth)), threads_(threads) {
  if (truth_) truth_ = gonio::resample(*truth_, gonio::valid_cells(), threads_);
}

/// Keeps the start, rounds 1 and 2, and the last two rounds.
void iteration_figure::keep(moment now) {
  moments_.push_back(std::move(now));
  if (moments_.size() > 5) moments_.erase(moments_.begin() + 3);
}

gonio::image iteration_figure::draw_input() const { return measurements_tile(samples_); }

/// Uses the table rather than the run, which may use only some of the samples.
gonio::image iteration_figure::draw_factors(const moment& before) const {
  return samples_tile(samples_, gonio::rgb::Zero(), [&](Eigen::Index i) {
    const gonio::location at = gonio::locate(before.estimate.cells(), samples_[i].angles());
    const Eigen::Array3f measured = samples_[i].value.cast<float>(), estimate = before.estimate.at(at).cast<float>();
    const Eigen::Array3f sigma = corrections_.rule().factor.quotient(measured, estimate);
    return factor_colour(sigma.cast<double>());
  });
}

gonio::image iteration_figure::draw_correction(const moment& round) const {
  return factor_tile(gonio::fitted_brdf{corrections_, round.weights}, threads_);
}

gonio::image iteration_figure::draw_true_correction(const moment& before) const {
  const auto sigma = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    const Eigen::Array3f truth = (*truth_)(wi, wo).cast<float>(), estimate = before.estimate(wi, wo).cast<float>();
    return Eigen::Array3f(corrections_.rule().factor.quotient(truth, estimate)).cast<double>();
  };
  return factor_tile(sigma, threads_);
}

iteration_image iteration_figure::draw() const {
  const gonio::brdf_table& reference = truth_ ? *truth_ : moments_.back().estimate;
  const sphere_tiles spheres({reference.cells(), gonio::render::environment_lighting{}, cells_across_tile,
                              gonio::sphere_delta_e::middle_grey, threads_},
                             reference, threads_);
  iteration_image result;
  std::vector<std::vector<labelled_tile>> columns;

  // The given data.
  if (truth_)
    columns.push_back(
        {{slice_tile(*truth_, threads_), "truth"}, {spheres.sphere(*truth_), "truth"}, {draw_input(), "measurements"}});
  else
    columns.push_back({{draw_input(), "measurements"}});

  for (std::size_t i = 0; i < moments_.size(); ++i) {
    if (i > 2 && i + 1 < moments_.size()) continue;  // kept only as the predecessor of the last round
    const moment& now = moments_[i];
    if (i > 0) {
      const moment& before = moments_[i - 1];
      columns.push_back({{draw_factors(before), "factors at the samples"}, {draw_correction(now), "factors found"}});
      if (truth_) columns.back().push_back({draw_true_correction(before), "true factors"});
      columns.back().push_back(factor_scale_tile());
    }
    const std::string name = i == 0 ? "start" : "round " + std::to_string(now.round);
    columns.push_back({{slice_tile(now.estimate, threads_), name}, {spheres.sphere(now.estimate), name}});
    if (!truth_) continue;
    auto [image, mean] = spheres.difference(now.estimate);
    columns.back().push_back({std::move(image), "Delta E " + fixed(mean, 2)});
    columns.back().push_back(delta_e_scale_tile());
    result.differences.emplace_back(now.round, mean);
  }
  result.image = tiles_in_columns(columns);
  return result;
}

}  // namespace cli
