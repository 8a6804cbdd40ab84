// The bodies of estimate/scattered_brdf.hpp, which need nanoflann.

#include <gonio/estimate/impl/scattered_brdf.ipp>
