// The bodies of io/images/exif.hpp, which need libexif.

#include <gonio/io/images/impl/exif.ipp>
