#pragma once
/// The subcommands of `gonio shape`, and their shared functions.

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

/// Renders a surface from two sides, coloured by signed distances from a reference: blue inside, white on it, red
/// outside; grey without distances. The colour is pure blue at -`largest` mm and pure red at `largest` mm. The image of
/// each side has `pixels` x `pixels`.
[[nodiscard]] gonio::image shape_image(const gonio::shape::triangle_mesh& mesh, const Eigen::VectorXd& distances,
                                       double largest, std::size_t pixels = 240);

/// Returns the pose from a scan to the model by shape context. Throws gonio::error if the scan matches nowhere.
[[nodiscard]] gonio::shape::similarity_transform find_pose(const gonio::shape::shape_model& model,
                                                           const gonio::shape::triangle_mesh& scan,
                                                           gonio::thread_count threads);

}  // namespace cli
