// The bodies of solve/ that instantiate Eigen's kernels: products and factorisations.

#include <gonio/solve/impl/cholesky.ipp>
#include <gonio/solve/impl/float_product.ipp>
#include <gonio/solve/impl/product.ipp>
#include <gonio/solve/impl/semidefinite.ipp>
#include <gonio/solve/impl/singular_values.ipp>
#include <gonio/solve/impl/symmetric_eigen.ipp>
#include <gonio/solve/impl/thin_product.ipp>
