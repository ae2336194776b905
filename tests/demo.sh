#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
#
# demo.sh VSPLIT FOLDER: bakes the sample whale and cuts its levels of detail into FOLDER, with a table of what they cost.
set -euo pipefail
vsplit=$1 out=$2
mkdir -p "$out"

"$vsplit" sample whale --mesh --triangles 100000 -f -o "$out/whale.ply"
"$vsplit" bake "$out/whale.ply" -f -o "$out/whale.pmesh"
echo
printf '%-8s %12s %14s %14s  %s\n' level triangles bytes error file
for percent in 100 60 40 10 1; do
  file="$out/whale-$percent.glb"
  ratio=$(awk "BEGIN { print $percent / 100 }")
  "$vsplit" extract "$out/whale.pmesh" --ratio "$ratio" -f -o "$file" --json >"$out/level.json"
  number() { sed -n "s/^ *\"$1\": \([^,]*\),\{0,1\}$/\1/p" "$out/level.json"; }
  printf '%-8s %12s %14s %14.3g  %s\n' "$percent %" "$(number triangles)" "$(number bytes)" "$(number error)" "$file"
done
rm -f "$out/level.json"
"$vsplit" lods "$out/whale.pmesh" --ratios 1,0.6,0.4,0.1,0.01 -f -q -o "$out/whale-lods.glb"
echo
printf 'All of them together in one file:  %s (%s bytes)\n' "$out/whale.pmesh" "$(stat -c %s "$out/whale.pmesh")"
printf 'As one GLB with MSFT_lod:          %s (%s bytes)\n' "$out/whale-lods.glb" "$(stat -c %s "$out/whale-lods.glb")"
