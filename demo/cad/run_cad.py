"""FreeCAD runs this file, without a window: `freecadcmd run_cad.py`, with RMAC_DEMO, a JSON object of `address`, `rmac`, `tree`, `out` and
`scallop_mm`. The last line is the figures as JSON; the exit code is 0 only if every figure is within its bound."""

import json
import os
import pathlib
import sys
import traceback

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / "clients/freecad/RMAC")]
BEGIN = "== the session begins"
STDOUT = 1  # FreeCAD's own one swallows lines while it recomputes


def say(text):
    os.write(STDOUT, f"\n{text}\n".encode())  # FreeCAD may be in the midst of a line


def main():
    given = json.loads(os.environ["RMAC_DEMO"])
    out = pathlib.Path(given["out"])
    out.mkdir(parents=True, exist_ok=True)
    say(BEGIN)
    try:
        import story

        line = story.tell(given["address"], given["rmac"], pathlib.Path(given["tree"]), out, given["scallop_mm"], say)
    except Exception as error:  # whatever it is, the demo says it and ends with 1
        traceback.print_exc(file=sys.stderr)
        say(json.dumps({"ok": False, "error": f"{type(error).__name__}: {error}"}))
        return 1
    say(json.dumps(line))
    return 0 if line["ok"] else 1


code = main()
sys.stderr.flush()
os._exit(code)
