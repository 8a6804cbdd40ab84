// The bodies of metric/.

#include <gonio/metric/impl/log_relative.ipp>
#include <gonio/metric/impl/root.ipp>
