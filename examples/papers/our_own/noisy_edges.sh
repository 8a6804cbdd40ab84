#!/bin/sh
# Prints mean absolute errors of `gonio shape demo` in holes with noisy edges as a table:
#   gonio-papers run --markdown docs/results/shapes.md -- examples/papers/our_own/noisy_edges.sh
# GONIO is the tool (default: gonio); the options are those of `gonio shape demo`.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo "| hole, noise in mm | thin plate | Algorithm 1 | + local smoothing | gonio |"
echo "|---|---|---|---|---|"
for scan in "large 0.25" "large 0.5" "large 1" "small 0.5"; do
  hole=${scan% *} noise=${scan#* }
  "${GONIO:-gonio}" shape demo "$@" --hole "$hole" --edge-noise "$noise" -o "$folder" |
    awk -v scan="$hole, $noise" '$1 == "all" { printf "| %s | %s | %s | %s | %s |\n", scan, $2, $3, $4, $5 }'
done
