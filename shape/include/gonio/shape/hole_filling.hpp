#pragma once
/// Fills holes of a surface smoothly from their surroundings alone. This is the baseline for recovery by the statistics
/// of many shapes: "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V,
/// section 4) compares with such a method. The energies are those of Kobbelt, Campagna, Vorsatz and Seidel,
/// "Interactive multi-resolution modeling on arbitrary meshes" (SIGGRAPH 1998, doi:10.1145/280814.280831), section 3.

#include <gonio/shape/mesh_topology.hpp>

#include <vector>

namespace gonio::shape {

/// The energy that a filled hole minimises.
enum class smoothness {
  membrane,   ///< squared edge lengths: each filled vertex is the mean of its neighbours; creased at the rim
  thin_plate  ///< squared distances of vertices from the mean of their neighbours: continues the slope at the rim
};

/// Returns the points (3 x vertices); the unknown points minimise the energy. The given positions of unknown points
/// have no influence and may be infinite or NaN. All neighbours have the same weight: cotangents would need the missing
/// positions, and on a template's near-equilateral triangles the difference is small. Thin plates reproduce planes on
/// even meshes. In a hole that reaches the mesh's border, they extrapolate the rim's slope and soon deviate far.
///
/// A sparse Cholesky factorisation: about O(n^1.5) for n missing vertices. Throws gonio::error unless there are as many
/// points and marks as vertices, each connected part has a known vertex, known points are finite, and they determine
/// the others. (One ring of a tube does not determine the slope of a thin plate.)
[[nodiscard]] point_columns fill_smoothly(const mesh_topology& topology, point_columns points,
                                          const std::vector<bool>& known, smoothness kind = smoothness::thin_plate);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/hole_filling.ipp>
#endif
