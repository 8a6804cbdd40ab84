// The bodies of conformity/.

#include <gonio/conformity/impl/conformity.ipp>
