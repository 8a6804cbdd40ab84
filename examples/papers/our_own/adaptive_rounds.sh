#!/bin/sh
# The directions that five adaptive rounds choose. adaptive_rounds.sh MATERIAL.bsdf... measures each material in five
# designed directions and five further ones, each chosen from the readings so far, and prints the further ones.
#   PICTURES=docs/pictures gonio-papers run --markdown docs/results/adaptive-design.md -- \
#     examples/papers/our_own/adaptive_rounds.sh chm_mint.bsdf acrylic_felt_white.bsdf
# GONIO is the tool (default: gonio), PICTURES a folder for a drawing of each material (default: no drawings).
set -eu
gonio=${GONIO:-gonio}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
echo "| material | direction | theta_i | theta_o | phi_o |"
echo "|---|---|---|---|---|"
"$gonio" design -n 5 --search exchange -o "$folder/first.csv" > "$folder/log"
for material in "$@"; do
  name=$(basename "$material" .bsdf)
  cp "$folder/first.csv" "$folder/all.csv"
  "$gonio" convert "$material" "$folder/truth.binary" > "$folder/log"
  for round in 1 2 3 4 5; do
    "$gonio" sample "$folder/truth.binary" --directions "$folder/all.csv" -o "$folder/samples.csv" > "$folder/log"
    "$gonio" design --given "$folder/samples.csv" -n 1 -o "$folder/next.csv" > "$folder/log"
    tail -n 1 "$folder/next.csv" >> "$folder/all.csv"
  done
  "$gonio" plan "$folder/all.csv" ${PICTURES:+--image "$PICTURES/adaptive-$name.png"} > "$folder/plan"
  awk -F'|' -v name="$name" '$2 + 0 > 5 { print "| " name " |" $2 "|" $3 "|" $4 "|" $5 "|" }' "$folder/plan"
done
