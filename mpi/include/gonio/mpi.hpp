#pragma once
/// Work on several machines: includes all of `mpi/`. The rest of the library needs no MPI library (gonio::mpi).

#include <gonio/mpi/best_of_ranks.hpp>
#include <gonio/mpi/gather_in_order.hpp>
#include <gonio/mpi/ranks.hpp>
#include <gonio/mpi/sum_of_groups.hpp>
