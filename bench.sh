#!/usr/bin/env bash
# The figures. Each bench prints a table and one JSON line.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

benches=(motion servo bus machines api)
wanted=("${@:-${benches[@]}}")
failed=0
for bench in "${wanted[@]}"; do
  case " ${benches[*]} " in
    *" $bench "*) ;;
    *) echo "usage: ./bench.sh [${benches[*]}]" >&2; exit 2 ;;
  esac
  if [ -x "tests/benchmark/$bench/run" ]; then
    "tests/benchmark/$bench/run" || failed=1
  else
    echo "bench.sh: the bench '$bench' does not exist yet: nothing was measured" >&2
    failed=1
  fi
done
exit $failed
