#pragma once
/// How a file of samples was read, in a line that a person can check.

#include "tool/files/json.hpp"
#include <gonio/io/measurements/samples.hpp>

namespace cli {

/// Returns three facts about a file of samples: `read_as`, a sentence ("90 samples in the plane of incidence; theta_i
/// 0, 30, 60 degrees; theta_o -80 to 80 degrees, negative on the mirror direction's side; 550 nm, percent of a white
/// diffuser"); `options`, which state the same on the command line; and `unsure_of`, sentences on doubtful assumptions.
[[nodiscard]] json read_as(const gonio::io::sample_file& file);

}  // namespace cli
