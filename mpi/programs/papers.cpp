/// `gonio-papers-mpi`: runs the experiments of gonio-papers that store their results on the ranks of an MPI job.

#include "job.hpp"
#include "papers/experiments.hpp"

int main(int argc, char** argv) {
  return cli::run_in_ranks(
      argc, argv,
      {"gonio-papers-mpi", "Experiments of gonio-papers on the ranks of an MPI job: mpirun -n 4 gonio-papers-mpi ...",
       [](cli::command& app, const std::vector<std::string>&, const cli::team& processes) {
         papers::add_resumable(app, processes);
       }});
}
