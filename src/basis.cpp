// The bodies of basis/.

#include <gonio/basis/impl/highlight_contrast.ipp>
#include <gonio/basis/impl/learn_pca.ipp>
#include <gonio/basis/impl/misplacement.ipp>
#include <gonio/basis/impl/rbf.ipp>
