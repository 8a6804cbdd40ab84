#!/bin/sh
# Updates docs/results/benchmarks.md:
#   bench/page.sh build/release OLDER/build/release
# Both arguments are release builds with benchmarks (the first with GONIO_PEERS, see bench/peers/CMakeLists.txt). The
# older one is of an earlier commit, with its bench/ replaced by this one where that compiles. Takes about ten minutes
# on an idle machine.
set -e
build=$(cd "$1" && pwd)
older=$(cd "$2" && pwd)
cd "$(dirname "$0")/.."
PATH=$PWD/bench:$build/bench:$build/bench/peers:$PATH
page=$PWD/docs/results/benchmarks.md
print() {
  "$build/bin/gonio-papers" run --markdown "$page" -- "$@"
}
lookups='reading|one_by_one<.*float>|many_at_once<.*float>'
print shares.py --before "$older/bench/bench_render_lookup_table" bench_render_lookup_table "--benchmark_filter=$lookups" \
  --benchmark_min_time=0.2
print shares.py --before "$older/bench/bench_estimate_decomposition" bench_estimate_decomposition --benchmark_min_time=0.2
print shares.py --before "$older/bench/bench_solve_gram" bench_solve_gram
print shares.py --before "$older/bench/bench_robust_correction" bench_robust_correction \
  '--benchmark_filter=round|basis|eigen|read'
print shares.py --before "$older/bench/bench_design_greedy_search" bench_design_greedy_search \
  '--benchmark_filter=sweep|read|product|set_up'
print shares.py --before "$older/bench/bench_basis_discrepancy" bench_basis_discrepancy
for peer in dj_brdf brdf_loader libbsdf; do print as_table.py bench_peers_$peer; done
