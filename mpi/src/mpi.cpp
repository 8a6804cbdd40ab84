// The implementations of mpi/, which need MPI.

#include <gonio/mpi/impl/best_of_ranks.ipp>
#include <gonio/mpi/impl/gather_in_order.ipp>
#include <gonio/mpi/impl/ranks.ipp>
#include <gonio/mpi/impl/sum_of_groups.ipp>
