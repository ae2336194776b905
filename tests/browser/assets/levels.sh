#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
#
# levels.sh VSPLIT OUT FILE.glb...: each scene at 100, 40 and 10 % side by side, mid-animation, drawn by three.js and by Babylon.js, and as one GLB with
# MSFT_lod in Babylon.js, which says the levels that it loads. Pictures for people: OUT/NAME-three.png, -babylon.png, -lod.png. Exits 1 if a page
# reports an error or a file does not load. Needs Chromium and npm install --prefix tests/browser.
set -euo pipefail
vsplit=$(realpath "$1")
mkdir -p "$2"
out=$(realpath "$2")
shift 2
render() { node "$(dirname "$0")/../render.mjs" --size 400 --time 0.7 "$@"; }
status=0
for file in "$@"; do
  name=$(basename "$file" .glb)
  "$vsplit" lods "$file" --ratios 1,0.4,0.1 --separate -q -f -o "$out/$name.glb"
  "$vsplit" lods "$file" --ratios 1,0.4,0.1 -q -f -o "$out/$name-msft.glb"
  for engine in three babylon; do
    render --engine $engine --out "$out/$name-$engine.png" "$out/$name-lod0.glb" "$out/$name-lod1.glb" "$out/$name-lod2.glb" || status=1
  done
  said=$(render --engine babylon --out "$out/$name-lod.png" "$out/$name-msft.glb") || status=1
  echo "$said"
  # Three levels, each with more triangles than the coarser one.
  read -r a b c <<<"$(sed -n 's/.*coarsest first: \([0-9]*\), \([0-9]*\), \([0-9]*\)$/\1 \2 \3/p' <<<"$said")"
  [ -n "$c" ] && [ "$a" -lt "$b" ] && [ "$b" -lt "$c" ] || { echo "$name: not every level was loaded"; status=1; }
done
exit $status
