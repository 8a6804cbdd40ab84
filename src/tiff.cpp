// The bodies of io/tiff.hpp, which need libtiff.

#include <gonio/io/impl/tiff.ipp>
