// The instantiations of estimate/reconstruction.hpp. A separate file, compiled in parallel with estimate.cpp.

#include <gonio/estimate/reconstruction.hpp>

namespace gonio {

template class fitted_brdf<reconstruction<log_relative>::basis_type>;
template class reconstruction<log_relative>;

}  // namespace gonio
