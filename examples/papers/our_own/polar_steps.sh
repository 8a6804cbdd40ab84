#!/bin/sh
# The errors of a table as a renderer's file over polar angles (.mbsdf), by its number of steps, and as a file that
# follows the highlight (.bsdf):
#   gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/polar_steps.sh merl_networks.npy
# Converts each table to the file and back. GONIO is the tool (default: gonio), NAMES are materials of the networks.
set -eu
[ $# -eq 1 ] || { echo "usage: polar_steps.sh NETWORKS" >&2; exit 2; }
networks=$1 gonio=${GONIO:-gonio}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
table=$folder/table.binary back=$folder/back.binary

# row NAME STEPS FILE
row() {
  "$gonio" convert "$3" "$back"
  "$gonio" compare "$back" "$table" > "$folder/errors"
  of() { sed -n "s/^$1 *\([0-9.]*\) .*/\1/p" "$folder/errors"; }
  megabytes=$(wc -c < "$3" | awk '{ printf "%.1f", $1 / 1e6 }')
  echo "| $1 | $2 | $megabytes | $(of 'cosine rms') | $(of 'Delta E, lights') | $(of 'Delta E, env') |" \
    "$(of 'peak ratio') |"
}

echo "| material | steps of theta | MB | cosine rms, 1/sr | Delta E, two lights | Delta E, environment | peak ratio |"
echo "|---|---|---|---|---|---|---|"
for name in ${NAMES:-white-fabric blue-rubber gold-metallic-paint red-plastic chrome}; do
  "$gonio" expand --networks "$networks" --name "$name" -o "$table"
  for steps in 45 90 180; do
    "$gonio" convert --polar-steps "$steps" "$table" "$folder/$steps.mbsdf"
    row "$name" "$steps" "$folder/$steps.mbsdf"
  done
  "$gonio" convert "$table" "$folder/table.bsdf"
  row "$name" ".bsdf" "$folder/table.bsdf"
done
