// The bodies of io/exr.hpp, which need OpenEXR.

#include <gonio/io/impl/exr.ipp>
