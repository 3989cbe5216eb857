#!/usr/bin/env python3
"""Imports each program of a folder, and says how many are taken and why others are not: tests/legacy/take_programs.py
--import build/release/bin/rmac-import FOLDER. What whoever imports a program knows of the machine is made up."""

import argparse
import collections
import pathlib
import re
import subprocess

BOUND_S = 100
SYSTEMS = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"]
KNOWN = ["--approach", "0,0,50", "--reference-point", "0,0,50", "--second-reference-point", "0,0,60", "--assume-g43", "--unit", "mm",
         "--tolerance", "0.01", *(word for system in SYSTEMS for word in ("--offset", f"{system}=0,0,0")),
         *(word for tool in range(1, 30) for word in ("--tool-diameter", f"{tool}=6")),
         *(word for number in range(4) for word in ("--output", f"{number}=Out{number}", "--input", f"{number}=In{number}"))]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--import", dest="program", required=True, help="rmac-import")
    arguments.add_argument("--glob", default="*.ngc", help="which files (*.ngc)")
    arguments.add_argument("--without", default="lathe", help="what the path of a file must not hold (lathe)")
    options = arguments.parse_args()
    files = [file for file in sorted(options.folder.rglob(options.glob)) if options.without not in str(file)]
    reasons = collections.Counter()
    for file in files:
        done = subprocess.run([options.program, file, "-o", "/dev/null", *KNOWN], capture_output=True, text=True, errors="replace",
                              timeout=BOUND_S, check=False)
        if done.returncode != 0:
            reasons[re.sub(r"(?<![GM\d.])\d+", "#", re.sub(r"^.*?:\d+:\d+: ", "", done.stderr.strip().splitlines()[-1]))] += 1
    for reason, count in reasons.most_common():
        print(f"{count:5} {reason}")
    print(f"{len(files) - sum(reasons.values())} of {len(files)} programs taken")


if __name__ == "__main__":
    main()
