/// Without nanoflann: refuses scattered samples and names the missing library.

#include "tool/options/scattered_samples.hpp"

#include <gonio/core/error.hpp>

namespace cli {

interpolated_samples interpolate(const gonio::sample_set&, const gonio::scattered_options&) {
  gonio::refuse("this build cannot interpolate scattered samples: it needs nanoflann (libnanoflann-dev)");
}

}  // namespace cli
