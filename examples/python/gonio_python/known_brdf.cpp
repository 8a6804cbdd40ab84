#include "known_brdf.hpp"

#include "command_line/measurement_files.hpp"

#include <cmath>
#include <sstream>
#include <utility>

namespace python {

namespace {

std::array<double, 3> channels_of(const gonio::rgb& colour) { return {colour[0], colour[1], colour[2]}; }

}  // namespace

std::string disagreement::sentence() const {
  std::ostringstream text;
  text.precision(3);
  text << "row " << row << ": measured " << measured[1] << ", the others say " << others_say[1] << " (green)";
  return text.str();
}

known_brdf::known_brdf(const log_discrepancy& estimator, const gonio::screened_samples& screened,
                       const std::vector<Eigen::Index>& rows)
    : fit_(estimator.fit_located(screened.kept)),
      known_(estimator, screened.kept),
      outlier_share_(screened.outlier_share) {
  for (const Eigen::Index number : screened.left_out) left_out_.push_back(rows[number]);
  for (const gonio::outlying_sample& out : screened.contradicted)
    disagreeing_.push_back(
        {rows[out.number], channels_of(out.measured), channels_of(out.predicted), out.deviation, out.probability});
}

double known_brdf::known_to(const gonio::direction& wi, const gonio::direction& wo) const {
  const gonio::location at = gonio::locate(fit_.cells(), gonio::to_half_difference(wi, wo));
  return std::expm1(known_.deviations_of(gonio::confidence_level::sixty_eight_percent) * known_.deviation(at));
}

discrepancy_estimator::discrepancy_estimator(gonio::log_relative_pca prior, double variance, double noise, bool rejects,
                                             unsigned threads)
    : estimator_(std::move(prior), {.variance = variance, .noise = noise}, gonio::thread_count{threads}),
      rejects_(rejects),
      threads_{threads} {
  if (!(variance > 0.0 && variance <= 10.0))
    gonio::refuse({"variance is ", variance, ": expected more than 0, at most 10"});
  if (!(noise >= 0.0 && std::isfinite(noise))) gonio::refuse({"noise is ", noise, ": expected at least 0"});
}

known_brdf discrepancy_estimator::fit(const gonio::sample_set& samples) const {
  const gonio::located_samples located = gonio::locate_samples(estimator_.prior().cells(), samples, threads_);
  gonio::screened_samples screened{located};
  if (rejects_) screened = gonio::screen(estimator_, located, threads_);
  return {estimator_, screened, cli::counting_samples(samples)};
}

}  // namespace python
