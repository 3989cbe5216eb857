"""Moves on their way to the machine: how many may be under way, which were taken, which are done. No I/O."""
