#pragma once
/// Where the bodies of functions that are no templates are compiled.
///
/// A header declares; such bodies stand in `<module>/impl/<name>.ipp`. The target `gonio::gonio` has the header include
/// them, as inline functions. The target `gonio::compiled` defines GONIO_COMPILED: then headers only declare, and the
/// bodies are compiled once, in the library that this target links.

#if defined(GONIO_COMPILED)
#define GONIO_INLINE
#else
#define GONIO_INLINE inline
#endif
