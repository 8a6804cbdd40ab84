#pragma once
/// The options of the experiments with synthetic ears.

#include "papers/experiments.hpp"
#include "tool/options/threads_option.hpp"
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <cstdint>

namespace papers {

struct ear_options {
  Eigen::Index shapes = 310;  ///< to learn from
  Eigen::Index ears = 10;     ///< to recover
  std::uint64_t seed = 1;
  gonio::thread_count threads = {};
};

inline void add_ear_options(command& to, ear_options& options) {
  to.add_option("--shapes", options.shapes, "Number of shapes to learn from")
      .check(check::range(3, 100000))
      .capture_default_str();
  to.add_option("--ears", options.ears, "Number of ears to recover")
      .check(check::range(1, 10000))
      .capture_default_str();
  to.add_option("--seed", options.seed, "Seed of all random numbers").capture_default_str();
  add_threads_option(to, options.threads);
}

}  // namespace papers
