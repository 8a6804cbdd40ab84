#pragma once
/// A program and the library that it links must align Eigen's matrices alike: -march and EIGEN_MAX_ALIGN_BYTES decide.
/// Where they differ, memory would be freed as it was not allocated. Here the program does not link instead, and the
/// linker names what it misses: `library_is_compiled_for_alignment<static, dynamic>`, both in bytes.

#include <gonio/core/compiled.hpp>

#include <Eigen/Core>

#if defined(GONIO_COMPILED)
namespace gonio::detail {

/// Defined in gonio::compiled, for its own alignments alone.
template <int Static, int Dynamic>
void library_is_compiled_for_alignment();

namespace {

[[gnu::used]] void (*const same_alignment)() =
    &library_is_compiled_for_alignment<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MAX_ALIGN_BYTES>;

}  // namespace

}  // namespace gonio::detail
#endif
