// The bodies of core/, and the alignment for which the library is compiled.

#include <gonio/core/compiled_alignment.hpp>
#include <gonio/core/impl/error.ipp>
#include <gonio/core/impl/finite.ipp>
#include <gonio/core/impl/lens_distortion.ipp>
#include <gonio/core/impl/parallel.ipp>
#include <gonio/core/impl/pinhole_camera.ipp>
#include <gonio/core/impl/printable.ipp>
#include <gonio/core/impl/probability.ipp>
#include <gonio/core/impl/random.ipp>
#include <gonio/core/impl/rotation.ipp>
#include <gonio/core/impl/spelling.ipp>
#include <gonio/core/impl/vector_kernels.ipp>
#include <gonio/core/impl/wavelengths.ipp>

namespace gonio::detail {

template <int Static, int Dynamic>
void library_is_compiled_for_alignment() {}

template void library_is_compiled_for_alignment<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MAX_ALIGN_BYTES>();

}  // namespace gonio::detail
