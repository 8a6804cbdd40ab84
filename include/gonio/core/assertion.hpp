#pragma once
/// Checks preconditions between the library's own functions. Invalid input from outside throws `gonio::error` instead.

#include <cassert>

/// Define GONIO_ASSERT before including gonio to install another handler.
#ifndef GONIO_ASSERT
#define GONIO_ASSERT(condition) assert(condition)
#endif
