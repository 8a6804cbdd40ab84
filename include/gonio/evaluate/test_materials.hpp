#pragma once
/// The test materials over which published figures are averaged. Leave them out of a prior, as the literature does, to
/// compare with these figures.

#include <string>
#include <vector>

namespace gonio {

/// The ten materials that Nielsen et al. 2015 (doi:10.1145/2816795.2818085) leave out of the prior (their Figure 2).
[[nodiscard]] const std::vector<std::string>& nielsen_test_materials();

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/test_materials.ipp>
#endif
