#!/bin/bash
# Inside the emulated machine: a simulated chip of 8 lines, and the GPIO adapter on it.
set -eu
source "$(dirname "$0")/simulated-gpio.sh"
"$1"
