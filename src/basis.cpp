// The bodies of basis/.

#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/impl/add_materials.ipp>
#include <gonio/basis/impl/component_variance.ipp>
#include <gonio/basis/impl/discrepancy.ipp>
#include <gonio/basis/impl/expand_materials.ipp>
#include <gonio/basis/impl/learn_pca.ipp>
#include <gonio/basis/impl/learn_streamed_pca.ipp>
#include <gonio/basis/impl/mapped_materials.ipp>
#include <gonio/basis/impl/rbf.ipp>
#include <gonio/basis/impl/soft_specular_prior.ipp>
#include <gonio/basis/measured.hpp>

namespace gonio {

template cell_matrix detail::map_by_channel(material_set&, const log&, thread_count);
template material_set expand(const log_relative_pca&, thread_count);
template log_relative_pca thin(const log_relative_pca&, const valid_cells&);

}  // namespace gonio
