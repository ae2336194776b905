#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
#
# fuzz.sh MINUTES: builds the library and the fuzz targets with clang, AddressSanitizer and UndefinedBehaviorSanitizer,
# and runs each of the three targets a third of the time, from the golden and malformed files on. What it finds stays in build/fuzz.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=$(( ${1:?"fuzz.sh MINUTES"} * 60 / 3 ))
[ "$seconds" -gt 0 ] || seconds=1
out=build/fuzz
mkdir -p "$out/seeds" "$out/objects"
flags=(-std=c++20 -O1 -g1 -ffp-contract=off -Ilib/include -fsanitize=address,undefined -fno-sanitize-recover=undefined)
objects=()
for source in lib/bytes/*.cpp lib/live/live_mesh.cpp lib/live/mesh.cpp lib/live/progressive_mesh.cpp tests/unit/family.cpp tests/unit/naive_record.cpp; do
  object=$out/objects/$(echo "$source" | tr / _).o
  objects+=("$object")
  if [ ! "$object" -nt "$source" ] || [ -n "$(find lib tests/unit -name '*.hpp' -newer "$object" -print -quit)" ]; then
    clang++ "${flags[@]}" -fsanitize=fuzzer-no-link -DVSPLIT_CORPUS='""' -c "$source" -o "$object"
  fi
done
cp formats/golden/*.pmesh formats/malformed/*.pmesh "$out/seeds"
for target in read stream round_trip; do
  clang++ "${flags[@]}" -fsanitize=fuzzer "tests/fuzz/$target.cpp" "${objects[@]}" -ldraco -o "$out/$target"
  mkdir -p "$out/corpus_$target"
  seeds=(); [ "$target" = round_trip ] || seeds=("$out/seeds")
  "$out/$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=1024 -max_len=20000 -dict=tests/fuzz/pmesh.dict \
    -artifact_prefix="$out/$target-" -print_final_stats=1 "$out/corpus_$target" ${seeds[@]+"${seeds[@]}"}
done
