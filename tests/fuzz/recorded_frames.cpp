/// Manifests of recorded frames. The frames themselves are PNG files, which have a harness of their own.

#include "harness.hpp"

#include <lab/recorded_frames.hpp>

namespace {

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes);
  const lab::recorded_frames frames(file.path());
  for (const gonio::direction_pair& pose : frames.poses()) static_cast<void>(frames.place(pose));
}

const fuzz::registered harness("recorded_frames", &read);

}  // namespace
