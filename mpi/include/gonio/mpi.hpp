#pragma once
/// Work on several machines: includes all of `mpi/`. It needs gonio::mpi (an MPI library); the rest of the library does
/// not.

#include <gonio/mpi/best_of_ranks.hpp>
#include <gonio/mpi/gather_in_order.hpp>
#include <gonio/mpi/ranks.hpp>
#include <gonio/mpi/sum_of_groups.hpp>
