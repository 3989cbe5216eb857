#!/bin/bash
# Inside the emulated machine: the CANopen tests on vcan0, with candump as a witness that shares no code with them.
set -u
ip link set lo up; ip link add dev vcan0 type vcan && ip link set vcan0 txqueuelen 256 up || exit 1
# Into memory first: a page of the program that had to come from the host in mid-cycle would cost cycles.
program=/run/$(basename "$1")
cp "$1" "$program"
ldd "$program" | awk '/=> \// {print $3}' | xargs cat > /dev/null
"$program" --gtest_list_tests > /dev/null
steady=CanopenOnVcan.MissesNoAnswerOfThreeDrivesAtOneKilohertz
code=0
candump -L vcan0,080:7FF > /run/sync.log & witness=$!
"$program" --gtest_filter="$steady" || code=1
kill $witness; wait $witness 2>/dev/null
/usr/bin/python3 "$(dirname "$0")/canopen_node.py" vcan0 5:1000 7 0x80000001 > /run/node.log & node=$!
until grep -q up /run/node.log || ! kill -0 $node; do sleep 0.1; done
"$program" --gtest_filter='CanopenWithPython.*' || code=1
kill $node; wait $node 2>/dev/null
"$program" --gtest_filter="-$steady:CanopenWithPython.*" || code=1  # interfaces go down in these, and candump would end
# SYNC by the kernel's clock: how far the time between two is from 1 ms.
/usr/bin/python3 - /run/sync.log <<'P' || code=1
import sys
times = [float(line.split()[0].strip("()")) for line in open(sys.argv[1]) if " 080#" in line]
off = sorted(abs(b - a - 0.001) * 1e6 for a, b in zip(times, times[1:]))
if len(off) < 5000:
    sys.exit(f"candump saw {len(times)} SYNCs only")
print(f"SYNC seen by candump: {len(times)}; off 1 ms by median {off[len(off) // 2]:.0f} us, p99 {off[len(off) * 99 // 100]:.0f} us, "
      f"p99.9 {off[len(off) * 999 // 1000]:.0f} us, at most {off[-1]:.0f} us")
P
exit "$code"
