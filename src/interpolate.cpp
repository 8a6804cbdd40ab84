// The bodies of interpolate/, but for what scattered.cpp has.

#include <gonio/interpolate/impl/pull_push.ipp>
#include <gonio/interpolate/impl/scattered_options.ipp>
