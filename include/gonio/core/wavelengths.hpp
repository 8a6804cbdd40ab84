#pragma once
/// Checks the wavelengths of a spectrum.

#include <span>

namespace gonio {

/// Throws gonio::error unless there is at least one wavelength and all are positive, finite and ascending. The message
/// names the first invalid one.
void require_wavelengths(std::span<const double> wavelengths);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/wavelengths.ipp>
#endif
