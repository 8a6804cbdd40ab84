// The bodies of io/exif.hpp, which need libexif.

#include <gonio/io/impl/exif.ipp>
