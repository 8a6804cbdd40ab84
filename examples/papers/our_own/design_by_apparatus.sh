#!/bin/sh
# The Delta E that `gonio design` expects for the prior's materials after measurements by each apparatus:
#   gonio-papers run --markdown docs/results/adaptive-design.md -- examples/papers/our_own/design_by_apparatus.sh
# GONIO is the tool (default: gonio).
set -eu
gonio=${GONIO:-gonio}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
touch "$folder/any.txt"
expected() { # of design's options
  "$gonio" design "$@" --json -o "$folder/d.csv" |
    sed -n 's/.*"expected_delta_e": \([0-9.]*\).*/\1/p' | xargs printf '%.2f'
}
echo "| apparatus | measurements | expected Delta E |"
echo "|---|---|---|"
for count in 3 5 6 10 20; do
  echo "| without limits and errors | $count | $(expected -n $count --constraint "$folder/any.txt") |"
done
for count in 3 5 6 10 20; do
  echo "| usual | $count | $(expected -n $count) |"
done
for name in three-axis-goniometer robot in-plane-arm by-hand; do
  for count in 5 10 20; do
    echo "| $name | $count | $(expected -n $count --apparatus $name) |"
  done
done
for count in 3 5 6; do
  echo "| multi-angle-$count | $count | $(expected -n $count --apparatus multi-angle-$count) |"
done
