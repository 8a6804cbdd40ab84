// The bodies of basis/.

#include <gonio/basis/impl/discrepancy.ipp>
#include <gonio/basis/impl/learn_pca.ipp>
#include <gonio/basis/impl/rbf.ipp>
