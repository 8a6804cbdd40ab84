#!/bin/sh
# The expected error of the sets that `gonio design` finds with several penalties, in sample and left out:
#   gonio-papers run --markdown docs/results/directions.md -- examples/papers/our_own/design_by_eta.sh thin.prior by-eta
# The sets are written to the folder as point-20-out-10.csv and so on, as `gonio-papers directions-measured` reads them.
# GONIO is the tool (default: gonio), COUNTS the numbers of points, ETAS the penalties.
set -eu
[ $# -eq 2 ] || { echo "usage: design_by_eta.sh PRIOR FOLDER" >&2; exit 2; }
prior=$1 folder=$2
mkdir -p "$folder"
: > "$folder/unlimited.txt" # an apparatus without limits and errors

# expected_error NAME COUNT ETA OPTION...
expected_error() {
  name=$1 count=$2 eta=$3
  shift 3
  "${GONIO:-gonio}" design --prior "$prior" -n "$count" --criterion expected-error --search descent --eta "$eta" \
    --constraint "$folder/unlimited.txt" "$@" --json -o "$folder/point-$count-$name-$eta.csv" | sed -n 's/.*"expected_error": *\([0-9.e-]*\).*/\1/p'
}

echo "| n | eta | in sample: E | left out: E |"
echo "|---|---|---|---|"
for count in ${COUNTS:-5 10 20}; do
  for eta in ${ETAS:-40 10 3 1}; do
    within=$(expected_error in "$count" "$eta" --in-sample)
    without=$(expected_error out "$count" "$eta")
    printf '| %s | %s | %.3f | %.3f |\n' "$count" "$eta" "$within" "$without"
  done
done
