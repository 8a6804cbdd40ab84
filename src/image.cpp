// The bodies of io/images/image.hpp, which need stb.

#include <gonio/io/images/impl/image.ipp>
