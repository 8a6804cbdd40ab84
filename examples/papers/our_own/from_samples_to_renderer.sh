#!/bin/sh
# GGX and Lambert lobes for a renderer from 20 measurements, fitted to these or to the table reconstructed from them:
#   gonio-papers run --markdown docs/results/models.md -- examples/papers/our_own/from_samples_to_renderer.sh
#     merl_networks.npy nielsen-20.csv
# GONIO is the tool (default: gonio), MATERIALS the test materials, METRIC the metric of the residuals.
set -eu
[ $# -eq 2 ] || { echo "usage: from_samples_to_renderer.sh NETWORKS DIRECTIONS" >&2; exit 2; }
networks=$1 directions=$2
tool=${GONIO:-gonio}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# errors ESTIMATE: the three figures of `gonio compare`, as cells of a table
errors() {
  "$tool" compare "$1" "$folder/truth.binary" --prior "$folder/90.prior" |
    awk '/^mapped rms/ { rms = $3 } /^Delta E, lights/ { lights = $4 } /^Delta E, env/ { env = $4 }
         END { printf "%.3f | %.2f | %.2f |\n", rms, env, lights }'
}

# fit WHAT LABEL
fit() {
  "$tool" fit "$1" --model ggx --metric "${METRIC:-cubic}" --loss l1 --no-cosine-weight -o "$folder/model.binary" > /dev/null
  printf '| | %s | %s\n' "$2" "$(errors "$folder/model.binary")"
}

excluded=
for name in black-soft-plastic blue-acrylic blue-metallic-paint2 green-fabric light-red-paint pink-jasper \
  silver-metallic-paint specular-violet-phenolic two-layer-silver white-fabric; do
  excluded="$excluded --exclude $name"
done
# shellcheck disable=SC2086 # words of their own
"$tool" learn --networks "$networks" $excluded --components 90 --thin 3 5 -o "$folder/90.prior" > /dev/null
echo "| material | what | mapped rms | Delta E env | Delta E lights |"
echo "|---|---|---|---|---|"
for material in ${MATERIALS:-light-red-paint specular-violet-phenolic silver-metallic-paint}; do
  "$tool" expand --networks "$networks" --name "$material" -o "$folder/truth.binary" > /dev/null
  "$tool" sample "$folder/truth.binary" --directions "$directions" -o "$folder/samples.csv" > /dev/null
  "$tool" reconstruct "$folder/samples.csv" --prior "$folder/90.prior" -o "$folder/table.binary" > /dev/null
  printf '| %s | reconstruction | %s\n' "$material" "$(errors "$folder/table.binary")"
  fit "$folder/truth.binary" "fit of the truth"
  fit "$folder/table.binary" "fit of the reconstruction"
  fit "$folder/samples.csv" "fit of the 20 samples"
done
