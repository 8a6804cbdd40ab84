#pragma once
/// xtensor's containers of fixed rank: `xt::xtensor`. Since xtensor 0.26 its headers are in folders.

#if __has_include(<xtensor/containers/xtensor.hpp>)
#include <xtensor/containers/xtensor.hpp>
#else
#include <xtensor/xtensor.hpp>
#endif
