// The bodies of io/images/tiff.hpp, which need libtiff.

#include <gonio/io/images/impl/tiff.ipp>
