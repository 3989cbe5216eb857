#!/bin/bash
# The daemon on CAN buses of a real kernel: loads a mill with four drives, moves it, and is killed in mid-move.
# usage: rmacd.sh [BUILD_FOLDER]      needs what canopen.sh needs
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(realpath "${1:-$here/../../build/release}")
cmake --build "$build" --target rmac-vdrive rmacd rmac rmac_modules
"$here/boot.sh" "$here/rmacd-guest.py" "$build"
