// The implementations of shape/ that use only meshes, with dlib and nanoflann.

#include <gonio/shape/impl/alignment.ipp>
#include <gonio/shape/impl/assignment.ipp>
#include <gonio/shape/impl/geodesic.ipp>
#include <gonio/shape/impl/hole_filling.ipp>
#include <gonio/shape/impl/mesh_image.ipp>
#include <gonio/shape/impl/mesh_part.ipp>
#include <gonio/shape/impl/mesh_surface.ipp>
#include <gonio/shape/impl/mesh_topology.ipp>
#include <gonio/shape/impl/shape_context.ipp>
#include <gonio/shape/impl/shape_context_alignment.ipp>
#include <gonio/shape/impl/surface_distance.ipp>
#include <gonio/shape/impl/surface_index.ipp>
#include <gonio/shape/impl/surface_noise.ipp>
#include <gonio/shape/impl/triangle_mesh.ipp>
