#!/usr/bin/env bash
# Installs the packages, builds, starts the appliance on its simulated bus, machines a headlight through its socket and leaves
# record, pictures and report in out/. The last line of the output is the figures as JSON.
#   measure       instead: cuts a part that is clamped wrong, measures it in the midst of the cut, corrects, and goes on
#   cad           instead: from a STEP file in FreeCAD to the part that is machined, measured, and its model corrected; installs FreeCAD
#   virtual       instead: a five-axis part whose first program would hit a clamp, found before it is cut; the second's predicted part against what is cut
#   --real-time   at the machine's own pace, instead of as fast as cycles can be computed
#   --out FOLDER  instead of out
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() { echo "usage: ./demo.sh [measure|cad|virtual] [--real-time] [--out FOLDER]" >&2; exit 2; }
pace=as-fast-as-computed
out=out
measure=
cad=
virtual=
while [ $# -gt 0 ]; do
  case "$1" in
    measure) measure=yes ;;
    cad) cad=yes ;;
    virtual) virtual=yes ;;
    --real-time) pace=real-time ;;
    --out) [ $# -gt 1 ] || usage; shift; out=$1 ;;
    *) usage ;;
  esac
  shift
done
case "$measure$cad$virtual" in yesyes*) usage ;; esac

lists=(packages.txt)
[ -z "$cad" ] || lists+=(packages-cad.txt)
./packages.sh "${lists[@]}"

echo "== build"
cmake --preset release --log-level=WARNING >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target rmacd rmac rmac_modules -- --quiet

echo "== start the appliance ($pace)"
state=$(mktemp -d)
log=$state/rmacd.log
daemon=
end() {
  if [ -n "$daemon" ] && kill -0 "$daemon" 2>/dev/null; then
    kill -TERM "$daemon"
    wait "$daemon" || true
  fi
  rm -rf "$state"
}
trap end EXIT

tree=()
if [ -n "$measure" ]; then
  /usr/bin/python3 -B demo/run_measure.py --clamp build/release/drivers "$state/drivers"
  tree=(--device-tree "$state/drivers")
fi
if [ -n "$cad" ]; then
  cp -r build/release/drivers "$state/drivers" # the simulated part is clamped there
  tree=(--device-tree "$state/drivers")
fi
if [ -n "$virtual" ]; then
  /usr/bin/python3 -B demo/virtual/run_virtual.py --tools "$state/tools"
fi

: >"$log" # the loop below may look before the daemon has opened it
build/release/bin/rmacd --config etc/rmacd.json --port 0 --pace "$pace" --state-dir "$state" "${tree[@]}" 2>"$log" &
daemon=$!
port=
until [ -n "$port" ]; do
  if ! kill -0 "$daemon" 2>/dev/null; then
    cat "$log" >&2
    echo "demo.sh: rmacd did not start; its log is above" >&2
    exit 1
  fi
  port=$(sed -n 's/.*listens on 127\.0\.0\.1:\([0-9]*\).*/\1/p' "$log" | head -n 1)
  [ -n "$port" ] || sleep 0.05
done

if [ -n "$cad" ]; then
  echo "== from the model to the measured part, in FreeCAD, through 127.0.0.1:$port"
  if ! /usr/bin/python3 -B demo/cad/start.py --address "127.0.0.1:$port" --tree "$state/drivers" --out "$out"; then
    grep -iE 'warn|err|crit' "$log" >&2 || true
    exit 1
  fi
  exit
fi

if [ -n "$measure" ]; then
  echo "== measure a part where it is cut, through 127.0.0.1:$port"
  session=demo/run_measure.py
elif [ -n "$virtual" ]; then
  echo "== rehearse a five-axis part, and machine it through 127.0.0.1:$port"
  session=demo/virtual/run_virtual.py
else
  echo "== machine the headlight through 127.0.0.1:$port"
  session=demo/run_demo.py
fi
if ! /usr/bin/python3 -B "$session" --host 127.0.0.1 --port "$port" --out "$out"; then
  grep -iE 'warn|err|crit' "$log" >&2 || true
  exit 1
fi
