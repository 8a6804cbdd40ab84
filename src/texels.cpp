// The bodies of texels/.

#include <gonio/texels/impl/texel_decomposition.ipp>
#include <gonio/texels/impl/texel_metric.ipp>
