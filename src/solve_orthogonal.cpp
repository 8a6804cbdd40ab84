// The bodies of solve/ that factorise orthogonally.

#include <gonio/solve/impl/least_squares.ipp>
#include <gonio/solve/impl/truncated_svd.ipp>
