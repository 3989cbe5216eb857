#!/usr/bin/env bash
# Installs the packages, builds, runs every test: as released, then under the address and undefined-behaviour sanitizers.
#   --fast   as released only
#   --tsan   the tests that have threads under the thread sanitizer too
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() { echo "usage: ./test.sh [--fast] [--tsan]" >&2; exit 2; }
presets=(release asan)
for option in "$@"; do
  case "$option" in
    --fast) presets=(release) ;;
    --tsan) thread_sanitizer=1 ;;
    *) usage ;;
  esac
done

./packages.sh

build() { # preset
  echo "== $1: configure and build"
  cmake --preset "$1" --log-level=WARNING
  cmake --build --preset "$1" --parallel "$(nproc)" -- --quiet
}

for preset in "${presets[@]}"; do
  build "$preset"
  echo "== $preset: tests"
  ctest --preset "$preset"
done
if [ -n "${thread_sanitizer:-}" ]; then
  build tsan
  echo "== tsan: tests"
  ctest --preset tsan --tests-regex 'Controller|Server|Channel|Ring|Thread'
fi
