#pragma once
/// All of `conformity/`: does a part reflect like a reference?

#include <gonio/conformity/conformity.hpp>
