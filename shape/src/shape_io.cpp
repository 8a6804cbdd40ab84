// The implementations of shape file formats.

#include <gonio/shape/io/impl/mesh.ipp>
#include <gonio/shape/io/impl/mesh_parts.ipp>
#include <gonio/shape/io/impl/obj.ipp>
#include <gonio/shape/io/impl/ply.ipp>
#include <gonio/shape/io/impl/pose.ipp>
#include <gonio/shape/io/impl/shape_model.ipp>
