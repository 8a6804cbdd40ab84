#!/bin/sh
# Prints the results of `gonio shape demo` as a table:
#   gonio-papers run --markdown docs/results/shapes.md -- examples/papers/our_own/recovered_ears.sh --hole large
# GONIO is the tool (default: gonio); the options are those of `gonio shape demo`. The last row has the mean sizes of the
# ten signed means that the paper prints: Markov random field, proposed, smoothed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${GONIO:-gonio}" shape demo "$@" -o "$folder" | awk '
  $1 == "#" { print "| # | thin plate | Algorithm 1 | + local smoothing | gonio |\n|---|---|---|---|---|" }
  $1 ~ /^[0-9]+$/ && NF == 9 { printf "| %s | %s %s | %s %s | %s %s | %s %s |\n", $1, $2, $3, $4, $5, $6, $7, $8, $9
    for (i = 1; i <= 4; ++i) size[i] += $(2 * i) < 0 ? -$(2 * i) : $(2 * i)
    ++ears }
  $1 == "all" && NF == 5 { printf "| mean of absolute | %s | %s | %s | %s |\n", $2, $3, $4, $5 }
  END { printf "| mean size of the signed means | %.3f | %.3f | %.3f | %.3f |\n",
               size[1] / ears, size[2] / ears, size[3] / ears, size[4] / ears
        print "| the same of the paper: random field, proposed, smoothed | 0.042 | 0.040 | 0.050 | |" }'
