// The bodies of io/images/exr.hpp, which need OpenEXR.

#include <gonio/io/images/impl/exr.ipp>
