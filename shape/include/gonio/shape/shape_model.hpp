#pragma once
/// An active shape model: principal components of shapes, and their common triangles. "Anatomically correct surface
/// recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/core/parallel.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/shape_basis.hpp>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape {

/// The model M(c) of Eq. 2. Copies share their storage.
class shape_model {
 public:
  /// Throws gonio::error unless the triangles are a surface of the basis' vertices.
  shape_model(shape_basis basis, triangle_columns triangles)
      : basis_(std::move(basis)),
        template_(std::make_shared<const surface_template>(std::move(triangles), vertices_of(basis_))) {}

  [[nodiscard]] const shape_basis& basis() const noexcept { return basis_; }
  [[nodiscard]] const triangle_columns& triangles() const noexcept { return template_->triangles; }
  [[nodiscard]] const mesh_topology& topology() const noexcept { return template_->topology; }
  [[nodiscard]] Eigen::Index vertices() const noexcept { return vertices_of(basis_); }
  /// Returns the number of shapes from which the model was learned.
  [[nodiscard]] Eigen::Index shapes() const noexcept { return basis_.names().size(); }

  [[nodiscard]] triangle_mesh mesh(point_columns vertices) const { return {std::move(vertices), triangles()}; }
  [[nodiscard]] triangle_mesh mean() const { return mesh(mean_shape(basis_)); }
  /// Returns M(c) for some weights: see `shape_of`.
  [[nodiscard]] triangle_mesh shape(const Eigen::VectorXd& weights) const { return mesh(shape_of(basis_, weights)); }

  /// Returns the model with only the components that explain a share of the variance: see `truncated_to_variance`.
  [[nodiscard]] shape_model truncated_to_variance(double share) const;

 private:
  struct surface_template {
    surface_template(triangle_columns all, Eigen::Index vertices)
        : triangles(std::move(all)), topology(triangles, vertices) {}

    triangle_columns triangles;
    mesh_topology topology;
  };

  [[nodiscard]] static Eigen::Index vertices_of(const shape_basis& basis) { return basis.cells().vertices; }

  shape_basis basis_;
  std::shared_ptr<const surface_template> template_;
};

/// Learns a model from corresponded shapes: aligns them (generalised Procrustes) and takes all their principal
/// components. O(vertices x shapes^2). Throws gonio::error for fewer than two different shapes, shapes with different
/// numbers of vertices, vertices that are not finite, or triangles that are not a surface.
[[nodiscard]] shape_model learn_shape_model(const std::vector<point_columns>& shapes, std::vector<std::string> names,
                                            triangle_columns triangles, thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_model.ipp>
#endif
