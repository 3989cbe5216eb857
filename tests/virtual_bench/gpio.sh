#!/bin/bash
# The GPIO adapter on a chip that the kernel simulates: builds the chip's module and the test program, and boots a machine.
# usage: gpio.sh [BUILD_FOLDER]      needs what canopen.sh needs, and root for gpio-sim.sh
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(realpath "${1:-$here/../../build/release}")
cmake --build "$build" --target gpio_on_sim
"$here/fetch-kernel.sh"
"$here/gpio-sim.sh"
"$here/boot.sh" "$here/gpio-guest.sh" "$build/tests/virtual_bench/gpio_on_sim"
