/// gonio shape where dlib and nanoflann are not: says what it needs.

#include "tool/commands/commands.hpp"
#include <gonio/core/error.hpp>

namespace cli {

void add_shape(command& app) {
  auto shape = app.add_subcommand("shape", "Recover surfaces that scans show in part (not in this build)");
  shape.allow_extras();
  shape.callback([] {
    gonio::refuse(
        "this program was built without shapes, which need dlib and nanoflann: build it again with them and "
        "-D GONIO_BUILD_SHAPE=ON");
  });
}

}  // namespace cli
