#!/bin/bash
# The CANopen master on a real CAN interface of the kernel: builds the test program and boots a machine that has vcan.
# usage: canopen.sh [BUILD_FOLDER]      needs qemu-system-x86 busybox-static cpio can-utils iproute2
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(realpath "${1:-$here/../../build/release}")
cmake --build "$build" --target canopen_on_vcan
"$here/boot.sh" "$here/canopen-guest.sh" "$build/tests/virtual_bench/canopen_on_vcan"
