// The bodies of solve/ that use orthogonal factorisations.

#include <gonio/solve/impl/least_squares.ipp>
#include <gonio/solve/impl/truncated_svd.ipp>
