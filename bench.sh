#!/usr/bin/env bash
# The figures. Each bench prints one JSON line a figure, and a table.
#   --quick   fewer cases, and says so
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

benches=(motion cam servo bus machines api clients virtual)
options=()
wanted=()
for word in "$@"; do
  case "$word" in
    --quick) options+=("$word") ;;
    *) wanted+=("$word") ;;
  esac
done
[ ${#wanted[@]} -gt 0 ] || wanted=("${benches[@]}")
failed=0
for bench in "${wanted[@]}"; do
  case " ${benches[*]} " in
    *" $bench "*) ;;
    *) echo "usage: ./bench.sh [--quick] [${benches[*]}]" >&2; exit 2 ;;
  esac
  if [ -x "tests/benchmark/$bench/run" ]; then
    "tests/benchmark/$bench/run" "${options[@]}" || failed=1
  else
    echo "bench.sh: the bench '$bench' does not exist yet: nothing was measured" >&2
    failed=1
  fi
done
exit $failed
