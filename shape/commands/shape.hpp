#pragma once
/// The steps of `gonio shape`, and what they have in common.

#include "tool/options/command.hpp"
#include <gonio/shape/mesh_image.hpp>
#include <gonio/shape/shape_context_alignment.hpp>
#include <gonio/shape/shape_model.hpp>

#include <vector>

namespace cli {

void add_shape_learn(command& shape);
void add_shape_recover(command& shape);
void add_shape_demo(command& shape);
void add_shape_grow(command& shape);
void add_shape_see(command& shape);

/// A surface from two sides, in the colours of signed distances: blue inside, green on, red outside of what it is
/// compared with; without distances in grey. `largest` mm are pure blue and red.
[[nodiscard]] gonio::image shape_image(const gonio::shape::triangle_mesh& mesh, const Eigen::VectorXd& distances,
                                       double largest);

/// Where a scan lies by shape context, from it to the model. Throws gonio::error if it matches nowhere.
[[nodiscard]] gonio::shape::similarity_transform find_pose(const gonio::shape::shape_model& model,
                                                           const gonio::shape::triangle_mesh& scan,
                                                           gonio::thread_count threads);

}  // namespace cli
