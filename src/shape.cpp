// The bodies of shape/, which need dlib and nanoflann.

#include <gonio/shape/impl/alignment.ipp>
#include <gonio/shape/impl/assignment.ipp>
#include <gonio/shape/impl/bootstrap.ipp>
#include <gonio/shape/impl/confidence.ipp>
#include <gonio/shape/impl/correspondence.ipp>
#include <gonio/shape/impl/cross_validated_uncertainty.ipp>
#include <gonio/shape/impl/fit_to_scan.ipp>
#include <gonio/shape/impl/fitted_shape.ipp>
#include <gonio/shape/impl/geodesic.ipp>
#include <gonio/shape/impl/hole_filling.ipp>
#include <gonio/shape/impl/mesh_part.ipp>
#include <gonio/shape/impl/mesh_picture.ipp>
#include <gonio/shape/impl/mesh_topology.ipp>
#include <gonio/shape/impl/recovery.ipp>
#include <gonio/shape/impl/registration.ipp>
#include <gonio/shape/impl/shape_basis.ipp>
#include <gonio/shape/impl/shape_context.ipp>
#include <gonio/shape/impl/shape_context_alignment.ipp>
#include <gonio/shape/impl/shape_model.ipp>
#include <gonio/shape/impl/shape_uncertainty.ipp>
#include <gonio/shape/impl/surface_distance.ipp>
#include <gonio/shape/impl/surface_index.ipp>
#include <gonio/shape/impl/surface_noise.ipp>
#include <gonio/shape/impl/triangle_mesh.ipp>
