#!/bin/bash
# Inside the emulated machine: how long Modbus transactions take beyond their deadline. The argument is the build folder and how many of each.
set -u
IFS=, read -r build transactions <<< "$1"
ip link set lo up
cp "$build/bin/bench_bus" /run/
ldd /run/bench_bus | awk '/=> \// {print $3}' | xargs cat > /dev/null
exec /run/bench_bus --only deadlines --transactions "$transactions"
