#!/bin/sh
# The errors of environments unwrapped from photographs of a mirror sphere, far away and at four radii, as a table:
#   gonio-papers run --markdown docs/results/laboratory.md -- examples/papers/our_own/light_probes.sh \
#     grace_probe_latlong.hdr studio_small_03_1k.hdr
# GONIO is the tool (default: gonio).
set -eu
gonio=${GONIO:-gonio}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# error ENVIRONMENT ROWS SIZE [--distance RADII]: prints the map's error as the tool reports it.
error() {
  environment=$1 rows=$2 size=$3
  shift 3
  "$gonio" lab probe "$environment" --size "$size" "$@" -o "$folder/probe.npy" > /dev/null
  "$gonio" lab unwrap "$folder/probe.npy" --rows "$rows" --truth "$environment" "$@" -o "$folder/map.npy" |
    sed -n 's/.* \([0-9.]* %\).*/\1/p'
}

echo "| environment | map | far away, 1,024 pixels | 2,048 | four radii, 1,024 | 2,048 |"
echo "|---|---|---|---|---|---|"
for environment in "$@"; do
  for rows in 64 128; do
    line="| $(basename "$environment" .hdr) | $rows rows |"
    for distance in "" "--distance 4"; do
      # shellcheck disable=SC2086
      for size in 1024 2048; do line="$line $(error "$environment" "$rows" "$size" $distance) |"; done
    done
    echo "$line"
  done
done
