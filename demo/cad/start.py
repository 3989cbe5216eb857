#!/usr/bin/env python3
"""Runs the demo in FreeCAD: without a window, and then its picture in a window that nobody sees, where there can be one.

The last line is the figures as JSON; the exit code is 0 only if every figure is within its bound.
"""

import argparse
import base64
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WINDOW = ROOT / "clients/freecad/tests/window/start.py"
PICTURE_S = 180
BEGIN = "== the session begins"  # of run_cad.py: what is before it, FreeCAD says
NOISE = re.compile(r"\s*\(\d+ %\)|\x1b\[[0-9;]*m|Recompute\.+|Importing\.+|<Import>.*|\*{2,}.*|.*(?:Step File Name|WorkSession|Transfer Mode|Transferring Shape).*")


def session(given, home):
    """FreeCAD's own lines, and its bars of progress, are left out."""
    environment = {**os.environ, "RMAC_DEMO": json.dumps(given), "FREECAD_USER_HOME": str(home), "PYTHONDONTWRITEBYTECODE": "1"}
    running = subprocess.Popen(["freecadcmd", str(HERE / "run_cad.py")], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, errors="replace")
    last, begun = "", False
    for line in running.stdout:
        text = NOISE.sub("", line).rstrip()
        if begun and text.strip():
            if last:
                print(last, flush=True)
            last = text
        begun |= text.startswith(BEGIN)
    return running.wait(), last


def picture(out, home):
    """FreeCAD's own picture of the measured part, put into the report; says so where there is none."""
    if not (shutil.which("freecad") and shutil.which("Xvfb")):
        return "no picture of FreeCAD's own: freecad and xvfb are not installed"
    environment = {**os.environ, "RMAC_DEMO_OUT": str(out), "PYTHONPATH": str(ROOT / "clients/freecad/RMAC"), "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        ended = subprocess.run([sys.executable, "-B", str(WINDOW), str(HERE / "picture_in_freecad.py")], env=environment, cwd=home, stdin=subprocess.DEVNULL,
                               capture_output=True, text=True, timeout=PICTURE_S, check=False)  # fmt: skip
    except subprocess.TimeoutExpired:
        return f"no picture of FreeCAD's own: its window took longer than {PICTURE_S} s"
    file = out / "freecad.png"
    if ended.returncode or not file.is_file():
        return f"no picture of FreeCAD's own: {(ended.stderr.strip().splitlines() or ['its window ended'])[-1]}"
    code = base64.b64encode(file.read_bytes()).decode()
    report = out / "report.html"
    report.write_text(report.read_text(encoding="utf-8").replace("</h1>", f'</h1><img alt="The part in FreeCAD, deviations in colours" src="data:image/png;base64,{code}">', 1), encoding="utf-8")
    return f"{file} is FreeCAD's own picture"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--address", required=True, help="of a running rmacd")
    parser.add_argument("--tree", required=True, help="its device tree, which is changed")
    parser.add_argument("--out", default="out", type=pathlib.Path)
    parser.add_argument("--rmac", default=str(ROOT / "build/release/bin/rmac"), help="the command line client")
    parser.add_argument("--scallop", default=0.05, type=float, help="mm, on the free-form face")
    parser.add_argument("--no-picture", action="store_true", help="without FreeCAD's window")
    arguments = parser.parse_args()
    if shutil.which("freecadcmd") is None:
        parser.error("freecadcmd is not installed; ./packages.sh packages-cad.txt brings it")
    out = arguments.out.resolve()
    given = {"address": arguments.address, "rmac": str(pathlib.Path(arguments.rmac).resolve()), "tree": str(pathlib.Path(arguments.tree).resolve()), "out": str(out), "scallop_mm": arguments.scallop}
    with tempfile.TemporaryDirectory(prefix="rmac-cad-") as home:
        code, line = session(given, home)
        if (out / "report.html").is_file() and not arguments.no_picture:
            print(f"  {picture(out, home)}")
    print(f"  {out / 'report.html'} has the pictures")
    print(line)
    return code


if __name__ == "__main__":
    sys.exit(main())
