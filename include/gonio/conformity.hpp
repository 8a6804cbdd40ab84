#pragma once
/// All of `conformity/`: tests whether a part reflects like a reference.

#include <gonio/conformity/conformity.hpp>
