// What is instantiated of estimate/reconstruction.hpp, apart from estimate.cpp so that both compile side by side.

#include <gonio/estimate/reconstruction.hpp>

namespace gonio {

template class fitted_brdf<reconstruction<log_relative>::basis_type>;
template class reconstruction<log_relative>;

}  // namespace gonio
