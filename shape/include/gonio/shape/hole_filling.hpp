#pragma once
/// Holes of a surface filled as smoothly as can be, from their surroundings alone: what recovery by the statistics of
/// many shapes has to beat ("Anatomically correct surface recovery", Nielsen, doctoral thesis, DTU 2016, contribution
/// C.V, section 4, compares itself with such a method). The energies are those of Kobbelt, Campagna, Vorsatz and
/// Seidel, "Interactive multi-resolution modeling on arbitrary meshes" (SIGGRAPH 1998, doi:10.1145/280814.280831),
/// section 3.

#include <gonio/shape/mesh_topology.hpp>

#include <vector>

namespace gonio::shape {

/// Of what there is least in a filled hole.
enum class smoothness {
  membrane,   ///< squared lengths of edges: each vertex is in the middle of its neighbours, and the rim is a crease
  thin_plate  ///< squared distances of vertices to their neighbours' middle: goes on as the surroundings slope
};

/// The points (3 x vertices) with those that are not known put where the energy is least; what they were, even not
/// finite, has no influence. All neighbours have the same weight: cotangents would need the positions that are missing,
/// or stretch what a reference has at that place, and on the near-equilateral triangles of a template the difference is
/// small. Thin plates reproduce planes on even meshes. They go on beyond the rim by its slope also where the hole is
/// open to the mesh's border, where they are soon far off.
///
/// A sparse Cholesky factorisation: about O(n^1.5) for n missing vertices. Throws gonio::error unless there are as many
/// points and marks as vertices, some vertex of each connected part is known, known points are finite and they
/// determine the others, as one ring of a tube does not the slope of a thin plate.
[[nodiscard]] point_columns fill_smoothly(const mesh_topology& topology, point_columns points,
                                          const std::vector<bool>& known, smoothness kind = smoothness::thin_plate);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/hole_filling.ipp>
#endif
