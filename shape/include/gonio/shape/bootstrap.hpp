#pragma once
/// An active shape model that grows by itself: a few annotated shapes register further scans, which it learns from.
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

/// A scan to learn from.
struct named_scan {
  std::string name;
  triangle_mesh mesh;
};

/// How a model grows.
struct bootstrap_options {
  shape_context_alignment_options alignment;
  double largest_distance = 5.0;  ///< mean distance of the model to an aligned scan, mm; above, the alignment failed
  registration_options registration;
  int passes = 4;        ///< over what was refused so far, at most
  double growth = 0.05;  ///< learn anew when there are so many more shapes, as a share of those learned from
};

/// What became of a scan.
struct bootstrap_outcome {
  double distance = 0.0;                   ///< after the alignment by shape context, mm
  std::optional<registration> registered;  ///< if that was near enough, the last attempt
  std::string refusal;                     ///< one sentence; empty if it was accepted
  int pass = 0;                            ///< of the last attempt, from 0

  [[nodiscard]] bool accepted() const noexcept { return refusal.empty(); }
};

/// The grown model, and what became of each scan, in their order.
struct bootstrap_result {
  shape_model model;
  std::vector<bootstrap_outcome> outcomes;

  [[nodiscard]] Eigen::Index accepted() const;
};

/// Grows a model from corresponded shapes by scans of any triangulation. Scans that are refused are tried again by the
/// grown model, until a pass over them accepts none. Throws gonio::error if the first shapes are no model (see
/// `learn_shape_model`); what is wrong with a scan is its outcome.
[[nodiscard]] bootstrap_result bootstrap_shape_model(std::vector<point_columns> shapes, std::vector<std::string> names,
                                                     triangle_columns triangles, std::span<const named_scan> scans,
                                                     const bootstrap_options& options = {}, thread_count threads = {},
                                                     const progress& listener = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/bootstrap.ipp>
#endif
