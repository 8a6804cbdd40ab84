// The bodies of render/.

#include <gonio/render/impl/environment_map.ipp>
#include <gonio/render/impl/environment_sampler.ipp>
#include <gonio/render/impl/exposure.ipp>
#include <gonio/render/impl/horizon_index.ipp>
#include <gonio/render/impl/image.ipp>
#include <gonio/render/impl/sampled_sphere.ipp>
#include <gonio/render/impl/sphere.ipp>
