/// Runs the one harness that this program is linked with on what libFuzzer makes up. Anything but a gonio::error that
/// names the file is a finding.

#include "../harness.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    fuzz::readers().front().read(std::as_bytes(std::span(data, size)));
  } catch (const gonio::error& refusal) {
    const std::string fault = fuzz::fault_of(refusal);
    if (fault.empty()) return 0;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
  }
  return 0;
}
