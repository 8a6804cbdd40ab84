/// `gonio-papers-mpi`: the experiments of gonio-papers that keep their results, on the ranks of an MPI job.

#include "job.hpp"
#include "papers/experiments.hpp"

int main(int argc, char** argv) {
  return cli::run_in_ranks(
      argc, argv,
      {"gonio-papers-mpi", "Experiments of gonio-papers on the ranks of an MPI job: mpirun -n 4 gonio-papers-mpi ...",
       [](cli::command& app, const std::vector<std::string>&, const cli::team& processes) {
         papers::add_noell_tables(app, processes);
         papers::add_noell_gap(app, processes);
         papers::add_directions(app, processes);
         papers::add_directions_measured(app, processes);
         papers::add_models(app, processes);
         papers::add_real_materials(app, processes);
         papers::add_real_fits(app, processes);
         papers::add_real_methods(app, processes);
         papers::add_adaptive_design(app, processes);
         papers::add_in_plane(app, processes);
         papers::add_near_field_photographs(app, processes);
         papers::add_sphere_photograph(app, processes);
       }});
}
