#pragma once
/// Upper limits of benchmarks for bench/shares.py: other benchmarks of the same program.

#include <benchmark/benchmark.h>

#include <string>

/// Names the benchmarks whose rates are limits: "read", "2 x product" for twice the rate, or several separated by "; ".
/// The binding limit is the one with the largest share. Rates are compared by a counter that both benchmarks have.
inline void limited_by(benchmark::State& state, const std::string& names) { state.SetLabel("limit: " + names); }

inline void count_operations(benchmark::State& state, double operations) {
  state.counters["GFlop/s"] = benchmark::Counter(1e-9 * operations, benchmark::Counter::kIsIterationInvariantRate);
}

inline void count_bytes(benchmark::State& state, double bytes) {
  state.counters["GB/s"] = benchmark::Counter(1e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
}
