#pragma once
/// What may be the wavelengths of a spectrum.

#include <span>

namespace gonio {

/// Refuses wavelengths that are none: throws gonio::error unless there is one at least and all are positive, finite and
/// ascending, naming the first that is not.
void require_wavelengths(std::span<const double> wavelengths);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/wavelengths.ipp>
#endif
