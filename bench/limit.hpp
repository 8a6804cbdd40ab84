#pragma once
/// What a benchmark could reach at best, for bench/shares.py: other benchmarks of the same program.

#include <benchmark/benchmark.h>

#include <string>

/// Names those whose rates are limits: "read", "2 x product" for twice the rate, or several with "; " between them, of
/// which that with the largest share is the one that binds. A rate is a counter that both have.
inline void limited_by(benchmark::State& state, const std::string& names) { state.SetLabel("limit: " + names); }

inline void count_operations(benchmark::State& state, double operations) {
  state.counters["GFlop/s"] = benchmark::Counter(1e-9 * operations, benchmark::Counter::kIsIterationInvariantRate);
}

inline void count_bytes(benchmark::State& state, double bytes) {
  state.counters["GB/s"] = benchmark::Counter(1e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
}
