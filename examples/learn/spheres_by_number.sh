#!/bin/sh
# Draws reconstructions from 1, 2, 5, 10 and 20 measurements as spheres with their Delta E, the truth at the right: a
# row for each pair of a table and a prior that has not seen such a material. The directions are the first ones that
# gonio design chooses; gonio reconstruct has its defaults.
#   gonio expand --formula red-paint -o red-paint.binary
#   examples/learn/spheres_by_number.sh why-twenty-spheres.png red-paint.binary examples/data/materials.prior
# GONIO is the tool (default: gonio).
set -eu
gonio=${GONIO:-gonio}
directions=$(dirname "$0")/../data/directions/point-20-perceived.csv
picture=$1
shift
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
row=0
while [ $# -ge 2 ]; do
  truth=$1 prior=$2 row=$((row + 1))
  shift 2
  for n in 1 2 5 10 20; do
    head -n $((n + 1)) "$directions" > "$folder/directions.csv"
    "$gonio" sample "$truth" --directions "$folder/directions.csv" -o "$folder/samples.csv" > "$folder/log"
    "$gonio" reconstruct "$folder/samples.csv" --prior "$prior" -o "$folder/estimate.binary" > "$folder/log" 2>&1
    off=$("$gonio" compare "$folder/estimate.binary" "$truth" --json | sed -n 's/.*"delta_e_env": *\([0-9.]*\).*/\1/p')
    column=$folder/$row/$(printf '%02d' "$n")
    mkdir -p "$column"
    mv "$folder/estimate.binary" "$column/$n measured, Delta E $(printf '%.1f' "$off").binary"
  done
  mkdir "$folder/$row/truth"
  cp "$truth" "$folder/$row/truth/$(basename "$truth")"
done
"$gonio" render "$folder"/*/*/*.binary* --labels --columns 6 --size 150 --exposure "${EXPOSURE:-0.4}" -o "$picture"
