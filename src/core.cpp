// The bodies of core/.

#include <gonio/core/impl/error.ipp>
#include <gonio/core/impl/finite.ipp>
#include <gonio/core/impl/parallel.ipp>
#include <gonio/core/impl/pinhole_camera.ipp>
