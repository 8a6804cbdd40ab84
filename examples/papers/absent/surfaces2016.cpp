/// Stands in for the experiments on shapes if dlib or nanoflann is missing. Each experiment prints which libraries it
/// needs.

#include "papers/experiments.hpp"
#include <gonio/core/error.hpp>

namespace papers {

namespace {

void add_absent(command& app, const char* name) {
  auto experiment = app.add_subcommand(name, "Needs shapes (not in this build)");
  experiment.allow_extras();
  experiment.callback([] {
    gonio::refuse(
        "this program was built without shapes, which need dlib and nanoflann: build it again with them and "
        "-D GONIO_BUILD_SHAPE=ON");
  });
}

}  // namespace

void add_shape_poses(command& app) { add_absent(app, "shape-poses"); }
void add_shape_fields(command& app) { add_absent(app, "shape-fields"); }
void add_shape_causes(command& app) { add_absent(app, "shape-causes"); }

}  // namespace papers
