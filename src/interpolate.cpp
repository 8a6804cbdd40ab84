// The bodies of interpolate/ except those in scattered.cpp.

#include <gonio/interpolate/impl/pull_push.ipp>
#include <gonio/interpolate/impl/scattered_options.ipp>
