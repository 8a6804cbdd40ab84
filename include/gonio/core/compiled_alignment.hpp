#pragma once
/// A program and the library that it links must align Eigen's matrices in the same way. The alignment depends on -march
/// and EIGEN_MAX_ALIGN_BYTES. If the alignments differed, memory would be freed with the wrong function. Such a program
/// therefore does not link: the linker reports that `library_is_compiled_for_alignment<static, dynamic>` is missing,
/// with the program's alignments in bytes.

#include <gonio/core/compiled.hpp>

#include <Eigen/Core>

#if defined(GONIO_COMPILED)
namespace gonio::detail {

/// Defined in gonio::compiled, only for the alignments of that library.
template <int Static, int Dynamic>
void library_is_compiled_for_alignment();

namespace {

[[gnu::used]] void (*const same_alignment)() =
    &library_is_compiled_for_alignment<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MAX_ALIGN_BYTES>;

}  // namespace

}  // namespace gonio::detail
#endif
