#!/bin/sh
# What `gonio shape demo` prints, as a table:
#   gonio-papers run --markdown docs/results/shapes.md -- examples/papers/our_own/recovered_ears.sh --hole large
# GONIO is the tool (default: gonio); the options are those of `gonio shape demo`.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${GONIO:-gonio}" shape demo "$@" -o "$folder" | awk '
  $1 == "#" { print "| # | thin plate | Algorithm 1 | + local smoothing | gonio |\n|---|---|---|---|---|" }
  $1 ~ /^[0-9]+$/ && NF == 9 { printf "| %s | %s %s | %s %s | %s %s | %s %s |\n", $1, $2, $3, $4, $5, $6, $7, $8, $9 }
  $1 == "all" && NF == 5 { printf "| mean of absolute | %s | %s | %s | %s |\n", $2, $3, $4, $5 }'
