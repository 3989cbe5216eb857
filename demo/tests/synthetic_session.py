"""Writes a whole synthetic run to a folder and judges it: to look at the report without the appliance."""

import pathlib
import sys

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

import entities  # noqa: E402
import figures  # noqa: E402
import synthesis  # noqa: E402
import toolpaths  # noqa: E402

if __name__ == "__main__":
    out = pathlib.Path(sys.argv[1])
    plan, *_ = toolpaths.make(out)
    sweep = entities.read_program(out / "headlight-sweep.rmac", start=[0, 0, 25.0])
    rim = entities.read_program(out / "headlight-rim.rmac", start=[*plan.wait_mm, 0.0])
    records = {"record.csv": synthesis.run(sweep), "record-rim.csv": synthesis.run(rim, held=[plan.part_origin_mm[2]])}
    session = figures.Session(problems=["this run is synthetic"])
    rows, line = figures.judge(out, sys.argv[2], session, records)
    figures.print_table(rows)
    print(line)
