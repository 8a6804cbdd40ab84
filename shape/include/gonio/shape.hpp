#pragma once
/// Statistical surface recovery: includes all of `shape/` and its file formats. It needs gonio::shape (dlib,
/// nanoflann); the rest of the library does not.

#include <gonio/shape/alignment.hpp>
#include <gonio/shape/assignment.hpp>
#include <gonio/shape/bootstrap.hpp>
#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/cross_validated_uncertainty.hpp>
#include <gonio/shape/fit_to_scan.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/geodesic.hpp>
#include <gonio/shape/hole_filling.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/io/mesh_parts.hpp>
#include <gonio/shape/io/obj.hpp>
#include <gonio/shape/io/ply.hpp>
#include <gonio/shape/io/pose.hpp>
#include <gonio/shape/io/shape_model.hpp>
#include <gonio/shape/mesh_image.hpp>
#include <gonio/shape/mesh_part.hpp>
#include <gonio/shape/mesh_surface.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/registration.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/shape/shape_context.hpp>
#include <gonio/shape/shape_context_alignment.hpp>
#include <gonio/shape/shape_model.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/shape/shape_with_motion.hpp>
#include <gonio/shape/surface_distance.hpp>
#include <gonio/shape/surface_index.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/shape/triangle_mesh.hpp>
