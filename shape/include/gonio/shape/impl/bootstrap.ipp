#pragma once
/// Bodies of shape/bootstrap.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/shape/bootstrap.hpp>
#include <gonio/shape/registration.hpp>
#include <gonio/shape/shape_context_alignment.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE Eigen::Index bootstrap_result::accepted() const {
  return std::ranges::count_if(outcomes, &bootstrap_outcome::accepted);
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

/// Shapes and their names, from which a model is learned repeatedly.
class growing_model {
 public:
  growing_model(std::vector<point_columns> shapes, std::vector<std::string> names, triangle_columns triangles,
                thread_count threads);

  [[nodiscard]] const shape_model& model() const noexcept { return model_; }

  void add(std::string name, point_columns shape);

  /// Returns the number of shapes not yet learned, relative to those learned.
  [[nodiscard]] double unlearned() const {
    return static_cast<double>(shapes_.size()) / static_cast<double>(model_.shapes()) - 1.0;
  }

  void learn() { model_ = learn_shape_model(shapes_, names_, model_.triangles(), threads_); }

 private:
  std::vector<point_columns> shapes_;
  std::vector<std::string> names_;
  thread_count threads_;
  shape_model model_;
};

GONIO_INLINE growing_model::growing_model(std::vector<point_columns> shapes, std::vector<std::string> names,
                                          triangle_columns triangles, thread_count threads)
    : shapes_(std::move(shapes)),
      names_(std::move(names)),
      threads_(threads),
      model_(learn_shape_model(shapes_, names_, std::move(triangles), threads)) {}

GONIO_INLINE void growing_model::add(std::string name, point_columns shape) {
  names_.push_back(std::move(name));
  shapes_.push_back(std::move(shape));
}

[[nodiscard]] GONIO_INLINE bootstrap_outcome attempt(const shape_model& model, const shape_context_matcher& matcher,
                                                     const triangle_mesh& scan, const bootstrap_options& options,
                                                     thread_count threads) {
  bootstrap_outcome outcome;
  try {
    const pre_alignment aligned = matcher.align(scan, threads);
    outcome.distance = aligned.mean_distance;
    if (aligned.mean_distance > options.largest_distance) {
      outcome.refusal = "its mean distance from the mean shape is " + std::to_string(aligned.mean_distance) +
                        " mm after the alignment, expected at most " + std::to_string(options.largest_distance);
      return outcome;
    }
    outcome.registered = register_scan(model, surface_index(scan), aligned.transform, options.registration, threads);
    outcome.refusal = outcome.registered->refusal;
  } catch (const error& refusal) {
    outcome.refusal = refusal.what();  // the mesh is not a surface, or shows hardly any of the model
  }
  return outcome;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE bootstrap_result bootstrap_shape_model(std::vector<point_columns> shapes, std::vector<std::string> names,
                                                    triangle_columns triangles, std::span<const named_scan> scans,
                                                    const bootstrap_options& options, thread_count threads,
                                                    const progress& listener) {
  detail::growing_model growing(std::move(shapes), std::move(names), std::move(triangles), threads);
  std::vector<bootstrap_outcome> outcomes(scans.size(), {0.0, {}, "it was not tried", 0});
  for (int pass = 0; pass < options.passes; ++pass) {
    const shape_context_matcher matcher(growing.model().mean(), options.alignment, threads);
    bool grew = false;
    for (Eigen::Index i = 0; i < std::ssize(scans); ++i) {
      report(listener, "pass " + std::to_string(pass + 1), static_cast<double>(i) / static_cast<double>(scans.size()));
      if (outcomes[i].accepted()) continue;
      outcomes[i] = detail::attempt(growing.model(), matcher, scans[i].mesh, options, threads);
      outcomes[i].pass = pass;
      if (!outcomes[i].accepted()) continue;
      grew = true;
      growing.add(scans[i].name, outcomes[i].registered->vertices);
      if (growing.unlearned() >= options.growth) growing.learn();
    }
    if (growing.unlearned() > 0.0) growing.learn();
    if (!grew) break;
  }
  return {growing.model(), std::move(outcomes)};
}

}  // namespace gonio::shape
