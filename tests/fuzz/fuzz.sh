#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
#
# fuzz.sh MINUTES [TARGET...]: builds the library and the fuzz targets with clang, AddressSanitizer and UndefinedBehaviorSanitizer,
# and runs them for MINUTES in all, one after the other on every processor, from the golden and malformed files on.
# What they find stays in build/fuzz.
set -euo pipefail
cd "$(dirname "$0")/../.."
workers=$(nproc)
seconds=$(( ${1:?"fuzz.sh MINUTES"} * 60 / 3 ))
[ "$seconds" -gt 0 ] || seconds=1
out=build/fuzz
mkdir -p "$out"

# CMake knows what depends on what; the folder has a build of its own.
cmake -S tests/fuzz -B "$out/build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ >/dev/null
cmake --build "$out/build"

rm -rf "$out/seeds"
mkdir -p "$out/seeds/read" "$out/seeds/stream" "$out/seeds/round_trip"
for file in formats/golden/*.pmesh formats/malformed/*.pmesh; do
  cp "$file" "$out/seeds/read"
  # The last 32 bytes tell how the file arrives.
  { cat "$file"; printf 'abcdefghijklmnopqrstuvwxyz012345'; } >"$out/seeds/stream/$(basename "$file")"
done
shift
[ $# -gt 0 ] || set -- read stream round_trip
for target in "$@"; do
  mkdir -p "$out/corpus_$target"
  # -fork: what one finds, all go on from; a crash ends the run.
  "$out/build/$target" -fork="$workers" -ignore_ooms=0 -ignore_timeouts=0 -max_total_time="$seconds" -timeout=20 -rss_limit_mb=1024 -max_len=20000 -dict=tests/fuzz/pmesh.dict \
    -artifact_prefix="$out/$target-" "$out/corpus_$target" "$out/seeds/$target" 2>"$out/$target.log" || {
    tail -60 "$out/$target.log" >&2
    echo "fuzz.sh: $target failed; the input is in $out, the log is $out/$target.log" >&2
    exit 1
  }
  printf '%s: %s\n' "$target" "$(grep -E '^#[0-9]+: cov' "$out/$target.log" | tail -1)"
done
