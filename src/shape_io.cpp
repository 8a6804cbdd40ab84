// The bodies of the files of shapes.

#include <gonio/io/impl/mesh.ipp>
#include <gonio/io/impl/mesh_parts.ipp>
#include <gonio/io/impl/obj.ipp>
#include <gonio/io/impl/ply.ipp>
#include <gonio/io/impl/shape_model.ipp>
