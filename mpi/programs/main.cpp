/// `gonio-mpi`: runs the tool's long subcommands on the ranks of an MPI job.

#include "job.hpp"
#include "tool/commands/commands.hpp"

int main(int argc, char** argv) {
  return cli::run_in_ranks(
      argc, argv,
      {"gonio-mpi", "The long subcommands of gonio on the ranks of an MPI job: mpirun -n 4 gonio-mpi ...",
       [](cli::command& app, const std::vector<std::string>& words, const cli::team& processes) {
         cli::add_design(app, words, processes);
         cli::add_learn(app, processes);
         cli::add_svbrdf(app, processes);
       }});
}
