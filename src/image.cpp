// The bodies of io/image.hpp, which need stb.

#include <gonio/io/impl/image.ipp>
