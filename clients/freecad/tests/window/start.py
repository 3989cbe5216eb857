#!/usr/bin/env python3
"""Runs a Python file in FreeCAD's window, on a screen of its own that nobody sees: start.py FILE. Ends with its exit code."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile

ADD_ON = pathlib.Path(__file__).resolve().parents[2] / "RMAC"
SCREEN = "1600x1000x24"
# Begins in a workbench that shows no web page, and asks nothing.
PREFERENCES = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
<FCParamGroup Name="General"><FCText Name="AutoloadModule">PartWorkbench</FCText><FCBool Name="ShowSplasher" Value="0"/></FCParamGroup>
</FCParamGroup></FCParamGroup></FCParamGroup></FCParameters>
"""


def screen():
    """The server and its display's name; it chooses a number that is free."""
    reads, writes = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writes), "-screen", "0", SCREEN, "-nolisten", "tcp"], pass_fds=[writes], stderr=subprocess.DEVNULL
    )
    os.close(writes)
    with os.fdopen(reads) as told:
        number = told.readline().strip()
    if not number:
        raise SystemExit("Xvfb did not start: is the package xvfb installed?")
    return server, f":{number}"


def run(file, home):
    (home / "user.cfg").write_text(PREFERENCES)
    server, display = screen()
    environment = {**os.environ, "DISPLAY": display, "QT_QPA_PLATFORM": "xcb", "LIBGL_ALWAYS_SOFTWARE": "1", "FREECAD_USER_HOME": str(home), "HOME": str(home)}
    try:
        command = ["freecad", "-u", home / "user.cfg", "-s", home / "system.cfg", "-M", ADD_ON, file]
        return subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, check=False).returncode
    finally:
        server.send_signal(signal.SIGTERM)
        server.wait()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="rmac-freecad-") as folder:
        sys.exit(run(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder)))
