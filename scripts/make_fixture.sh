#!/bin/sh
# Makes fixtures/rift-s-like-seed1 anew: scripts/make_fixture.sh [path of the eyebox binary]
# Frames are a function of the seed alone, so that only the date in the header changes.
set -eu

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
eyebox=${1:-$root/build/release/bin/eyebox}
fixture=$root/fixtures/rift-s-like-seed1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$eyebox" simulate sim:rift-s-like --seed 1 --out "$scratch/recording" \
  --levels 17 --exposures 0.0125,0.075,0.45 --repeats 2 --dark-repeats 8 --flat-repeats 8
"$eyebox" pack "$scratch/recording" --out "$scratch/packed"
cp "$scratch/recording/truth.json" "$scratch/recording/truth_g.npy" "$scratch/packed/"
"$eyebox" verify-files "$scratch/packed"

rm -rf "$fixture"
mkdir -p "$(dirname -- "$fixture")"
cp -R "$scratch/packed" "$fixture"
echo "Wrote $fixture ($(du -sk "$fixture" | cut -f1) KiB)"
