// The bodies of interpolate/scattered_brdf.hpp, which need nanoflann.

#include <gonio/interpolate/impl/scattered_brdf.ipp>
