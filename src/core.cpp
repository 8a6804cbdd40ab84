// The bodies of core/.

#include <gonio/core/impl/pinhole_camera.ipp>
