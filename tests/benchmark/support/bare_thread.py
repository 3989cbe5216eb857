"""What the computer itself grants, measured beside a bench: a process of the highest real-time priority that does nothing
but sleep from one millisecond to the next. A cycle that it misses too was missed by the computer."""

import os
import signal
import subprocess
import sys
import time

PERIOD_NS = 1_000_000


class BareThread:
    """Counts from when it is made until `misses` is asked for."""

    def __init__(self):
        self._process = subprocess.Popen([sys.executable, "-B", __file__], stdout=subprocess.PIPE, text=True)

    def misses(self):
        """None where the computer grants no real time at all."""
        self._process.send_signal(signal.SIGTERM)
        answer = self._process.communicate()[0].strip()
        return int(answer) if answer else None


def main():
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(os.sched_get_priority_max(os.SCHED_FIFO)))
    except PermissionError:
        signal.pause()
        return
    missed = 0
    due = time.monotonic_ns() + PERIOD_NS
    bench = os.getppid()
    while not ended and os.getppid() == bench:
        time.sleep(max(due - time.monotonic_ns(), 0) / 1e9)
        late = (time.monotonic_ns() - due) // PERIOD_NS
        missed += max(late, 0)
        due += (1 + max(late, 0)) * PERIOD_NS
    print(missed)


if __name__ == "__main__":
    main()
