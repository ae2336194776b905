#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# figures.sh VSPLIT VSPLIT_BENCH_PAPER FOLDER: figures 1 to 8 of the paper, for docs/paper.md. Needs xvfb and ImageMagick.
set -euo pipefail
vsplit=$(realpath "$1") bench=$(realpath "$2") out=$(realpath "$3")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
render() { xvfb-run -a "$vsplit" render "$@" --size 720x420 --quiet; }
beside() { convert "$1" "$2" +append -strip -colors 200 -define png:compression-level=9 "PNG8:$3"; }
alone() { convert "$1" -strip -colors 200 -define png:compression-level=9 "PNG8:$2"; }

"$bench" --meshes "$work" >table.md || true
# 1 and 2: points and their surfaces.
"$vsplit" sample whale --points 5000 -o whale.xyz --quiet
"$vsplit" sample ocean --points 20000 -o ocean.xyz --quiet
"$vsplit" reconstruct whale.xyz -o whale-surface.ply --quiet
"$vsplit" reconstruct ocean.xyz --open -o ocean-surface.ply --quiet
render whale.xyz --view 25,20 -o 1a.png
render whale-surface.ply --view 25,20 -o 1b.png
render ocean.xyz --view 25,35 -o 2a.png
render ocean-surface.ply --view 25,35 -o 2b.png
beside 1a.png 1b.png "$out/figure-1.png"
beside 2a.png 2b.png "$out/figure-2.png"
# 3 to 5: the whale of 2,645 vertices, 568 of them marked, by cost paper and automatic weights.
"$vsplit" bake whale-2645.ply --marks whale-2645.marks --cost paper --lossless -o whale.pmesh --quiet
render whale.pmesh --view 25,20 --wireframe -o 3.png
render whale.pmesh --view 25,20 --wireframe --ratio 0.6 -o 4.png
render whale.pmesh --view 25,20 --wireframe --ratio 0.4 -o 5.png
# 6 to 8: an ocean, a patch of it marked by a stroke. Cost quadric: cost paper has no term for boundaries, and frays them.
"$vsplit" sample ocean --mesh --triangles 5000 -o ocean.ply --quiet
cat >ocean.json <<'JSON'
[{"do": "stroke", "region": "patch", "space": "object", "radius": 1.2, "points": [[6, 0, 5], [7, 0, 5], [8, 0, 5.5], [9, 0, 6]]},
 {"do": "save-marks", "file": "ocean.marks"}]
JSON
"$vsplit" studio ocean.ply --script ocean.json --quiet
"$vsplit" bake ocean.ply --marks ocean.marks --lossless -o ocean.pmesh --json >ocean.txt
render ocean.pmesh --view 25,35 --wireframe -o 6.png
render ocean.pmesh --view 25,35 --wireframe --ratio 0.6 -o 7.png
render ocean.pmesh --view 25,35 --wireframe --ratio 0.4 -o 8.png
for n in 3 4 5 6 7 8; do alone $n.png "$out/figure-$n.png"; done
cat >counts.json <<'JSON'
[{"do": "load", "file": "ocean.marks"}, {"do": "level", "ratio": 1}, {"do": "apply"}, {"do": "level", "ratio": 0.6}, {"do": "level", "ratio": 0.4}]
JSON
"$vsplit" studio ocean.ply --script counts.json
