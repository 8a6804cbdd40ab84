#pragma once
/// Work beyond one machine: all of `mpi/`. Needs gonio::mpi (an MPI library), which the rest of the library does not.

#include <gonio/mpi/best_of_ranks.hpp>
#include <gonio/mpi/gather_in_order.hpp>
#include <gonio/mpi/ranks.hpp>
#include <gonio/mpi/sum_of_groups.hpp>
