#!/bin/sh
# The errors of maps from one light probe and from two merged, with a margin and a photographer of 12 degrees, as a
# table:
#   gonio-papers run --markdown docs/results/laboratory.md -- examples/papers/our_own/merged_probes.sh \
#     grace_probe_latlong.hdr
# GONIO is the tool (default: gonio).
set -eu
gonio=${GONIO:-gonio}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# error ENVIRONMENT OUTLINE ARGUMENT...: prints the map's error as the tool reports it.
error() {
  environment=$1 outline=$2
  shift 2
  "$gonio" lab unwrap "$@" --outline "$outline" --rows 64 --truth "$environment" -o "$folder/map.npy" |
    sed -n 's/^mean.* \([0-9.]* %\).*/\1/p'
}

echo "| environment | outline | one probe | two merged |"
echo "|---|---|---|---|"
for environment in "$@"; do
  for towards in 0,0 90,10; do
    "$gonio" lab probe "$environment" --margin 0.2 --photographer 12 --towards "$towards" -o "$folder/$towards.npy"
  done
  for outline in 512,512,426.6667 find; do
    one=$(error "$environment" "$outline" "$folder/0,0.npy")
    two=$(error "$environment" "$outline" "$folder/0,0.npy" "$folder/90,10.npy" --towards 0,0 --towards 90,10)
    echo "| $(basename "$environment" .hdr) | $outline | $one | $two |"
  done
done
