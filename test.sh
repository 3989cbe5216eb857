#!/usr/bin/env bash
# Installs the packages, checks the layout of the code, builds, the benches too, runs two scenarios in emulated machines and every test as released, then those of C++ under the
# address and undefined-behaviour sanitizers, and feeds the fuzz targets.
#   --fast   as released only
#   --lint   clang-tidy over all our sources too
#   --tsan   the tests that have threads under the thread sanitizer too
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() { echo "usage: ./test.sh [--fast] [--lint] [--tsan]" >&2; exit 2; }
presets=(release asan)
for option in "$@"; do
  case "$option" in
    --fast) presets=(release) ;;
    --lint) lint=1 ;;
    --tsan) thread_sanitizer=1 ;;
    *) usage ;;
  esac
done

# Says what begins, and how long the stage before it took.
stage=
begin() {
  [ -z "$stage" ] || printf '   %s: %d s\n' "$stage" $((SECONDS - begun))
  stage=$1
  begun=$SECONDS
  [ -z "$stage" ] || echo "== $stage"
}

begin "packages"
./packages.sh packages.txt packages-cad.txt

begin "layout: clang-format, rooms"
python3 tests/layout/check.py
python3 -m unittest discover -s tests/layout -q
find motion fieldbus drivers gateway clients tests -name '*.[ch]pp' -print0 | xargs -0 clang-format --dry-run --Werror

build() { # preset
  begin "$1: configure and build"
  cmake --preset "$1" --log-level=WARNING
  cmake --build --preset "$1" --parallel "$(nproc)" -- --quiet
}

for preset in "${presets[@]}"; do
  build "$preset"
  if [ "$preset" = release ]; then
    begin "benches: that they build"
    cmake --build --preset "$preset" --parallel "$(nproc)" --target benches canopen_on_vcan -- --quiet
    begin "bench: two emulated machines, a processor each"
    # Where one cannot be run in that many seconds, it says so.
    headlight=0 canopen=0
    LIMIT=420 tests/bench/run headlight &
    LIMIT=420 tests/bench/run canopen || canopen=$?
    wait $! || headlight=$?
    [[ $headlight =~ ^(0|77)$ && $canopen =~ ^(0|77)$ ]]
  fi
  begin "$preset: tests"
  ctest --preset "$preset"
  if [ "$preset" = asan ]; then
    begin "fuzz: strangers' bytes, 10 s a target"
    tests/fuzz/run --seconds 10
  fi
done
if [ -n "${lint:-}" ]; then
  begin "lint: types of the Python package"
  (cd clients/python && /usr/bin/python3 -m mypy --cache-dir ../../build/lint/mypy)
  begin "lint: clang-tidy, which proves what locks guard too"
  if clang-tidy --quiet tests/layout/unguarded_field.cpp -- -std=c++20 -I. >/dev/null 2>&1; then
    echo "lint: a field that is touched without its lock passed; see ExtraArgs of .clang-tidy" >&2
    exit 1
  fi
  # Each source by itself. clang 14 stops at the one option of g++ that it does not know.
  cmake --preset release -B build/lint -D RMAC_SOURCES_AT_A_TIME=1 --log-level=WARNING
  sed -i 's/ -fno-gnu-unique//g' build/lint/compile_commands.json
  find motion fieldbus drivers gateway clients -name '*.cpp' -print0 |
    xargs -0 -n 4 -P "$(nproc)" clang-tidy -p build/lint --quiet --extra-arg=-Wno-unknown-warning-option 2>/dev/null
fi
if [ -n "${thread_sanitizer:-}" ]; then
  build tsan
  begin "tsan: tests"
  ctest --preset tsan --tests-regex 'Controller|Server|Channel|Ring|Thread|TurnLock|Aside|Lease|Cycle|Announcer|Recorder'
fi
