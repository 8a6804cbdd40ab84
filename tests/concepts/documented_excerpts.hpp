#pragma once
// What the excerpts in comments of headers name: a program's measurements, materials and devices. Nothing runs.

#include <gonio/capture.hpp>
#include <gonio/design.hpp>
#include <gonio/estimate.hpp>
#include <gonio/evaluate.hpp>
#include <gonio/gonio.hpp>
#include <gonio/io.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/model.hpp>
#include <gonio/render.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/robust.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/solve.hpp>
#include <gonio/texels.hpp>

#include <cstdio>
#include <iostream>
#include <optional>
#include <vector>

namespace given {

// Measurements, priors and materials.
extern const gonio::log_relative_pca prior;
extern const gonio::valid_cells cells;
extern const gonio::sample_set samples;
extern const gonio::direction_pair pair;
extern const std::vector<gonio::sample_set> images;
extern gonio::material_set materials, database;
extern const gonio::brdf_table table, truth;
extern const std::vector<gonio::brdf_table> estimates;

// Problems.
extern const gonio::least_squares_problem problem;
extern const Eigen::MatrixXd D;
extern const Eigen::VectorXd d, start, lowest, highest;
gonio::local_parabola f(const Eigen::VectorXd& unknowns);
extern const double eta;
extern const bool fast, highlights;
extern const std::uint64_t seed;
extern const Eigen::Index row, found, expected;

// Noell et al.'s iteration.
extern const gonio::fitted_brdf<gonio::measured<gonio::log>> initial;
extern const gonio::correction corrections;
void plot(const gonio::correction_round& round);

// Cameras, lights and what they see.
extern const gonio::pinhole_camera pinhole;
extern const gonio::lens_camera camera;
extern const gonio::capture::surface_light lamp;
extern const std::optional<gonio::capture::white_reference> white;
extern const gonio::image image, photograph;
extern const double theta_i;
extern const gonio::capture::point_matrix points, second_image;
void estimate_from(const std::vector<Eigen::Index>& pixels);

// Renderers.
extern const std::vector<double> planes;
extern const gonio::direction wi, wo;
extern const double u1, u2;
extern const gonio::fitted_brdf<gonio::log_relative_pca> fit;
extern const Eigen::Index texel;
extern const std::vector<gonio::location> locations_of_images;
extern const Eigen::MatrixXf reflectance;

// Shapes.
extern const gonio::shape::shape_basis shapes;
extern const gonio::shape::vertex_observations known;

}  // namespace given
