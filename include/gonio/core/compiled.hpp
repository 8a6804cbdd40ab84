#pragma once
/// Decides where the bodies of functions that are not templates are compiled.
///
/// A header declares the functions; their bodies are in `<module>/impl/<name>.ipp`. With the target `gonio::gonio`, the
/// header includes them as inline functions. The target `gonio::compiled` defines GONIO_COMPILED: headers then only
/// declare, and the bodies are compiled once, in the library of that target.

#if defined(GONIO_COMPILED)
#define GONIO_INLINE
#else
#define GONIO_INLINE inline
#endif
