#pragma once
/// Preconditions between our own functions. Input from outside is refused with `gonio::error` instead.

#include <cassert>

/// The library's only macro: define it before including gonio to install another handler.
#ifndef GONIO_ASSERT
#define GONIO_ASSERT(condition) assert(condition)
#endif
