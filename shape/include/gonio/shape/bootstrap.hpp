#pragma once
/// Grows an active shape model: the model of a few annotated shapes registers further scans, and learns from them.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/core/progress.hpp>
#include <gonio/shape/registration.hpp>
#include <gonio/shape/shape_context_alignment.hpp>

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio::shape {

/// A scan as training data.
struct named_scan {
  std::string name;
  triangle_mesh mesh;
};

/// The settings for growing a model.
struct bootstrap_options {
  shape_context_alignment_options alignment;
  double largest_distance =
      5.0;  ///< largest mean distance from the mean shape to an aligned scan, mm; farther scans are refused
  registration_options registration;
  int passes = 4;        ///< largest number of passes over the scans refused so far
  double growth = 0.05;  ///< relearns the model after this relative increase in the number of shapes
};

/// The result of one scan.
struct bootstrap_outcome {
  double distance = 0.0;                   ///< mean distance after the alignment by shape context, mm
  std::optional<registration> registered;  ///< the last registration; empty if the distance was too large
  std::string refusal;                     ///< one sentence; empty if the scan was accepted
  int pass = 0;                            ///< pass of the last attempt, from 0

  [[nodiscard]] bool accepted() const noexcept { return refusal.empty(); }
};

/// The grown model, and the outcomes in the order of the scans.
struct bootstrap_result {
  shape_model model;
  std::vector<bootstrap_outcome> outcomes;

  [[nodiscard]] Eigen::Index accepted() const;
};

/// Learns a model from corresponded shapes, and grows it with scans of any triangulation. Each pass retries the refused
/// scans with the grown model; a pass that accepts none is the last. Throws gonio::error if the first shapes do not
/// give a model (see `learn_shape_model`). Errors of a scan are not thrown, but reported in its outcome.
[[nodiscard]] bootstrap_result bootstrap_shape_model(std::vector<point_columns> shapes, std::vector<std::string> names,
                                                     triangle_columns triangles, std::span<const named_scan> scans,
                                                     const bootstrap_options& options = {}, thread_count threads = {},
                                                     const progress& listener = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/bootstrap.ipp>
#endif
