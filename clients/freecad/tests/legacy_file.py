"""Files of other controls, as somebody sends them."""

import pathlib
import tempfile

SLOT = """%
(a slot, an arc, a hole)
G21 G17 G90
M6 T1 G43
G0 X0 Y0 Z20
M3 S800
G1 Z-1 F100
X10 F600
G2 X20 Y-10 I0 J-10
G81 X5 Y5 Z-2 R2
G80
G0 Z20
M30
%
"""
LINE_OF_ARC = 9
AWAY = "G21 M3 S800\nG0 X0 Y0 Z20\nG1 X10 F600\nX60\nX0\nM2\n"  # its fourth line leaves DMACXYZ
REFUSED_IN_ITS_MIDST = "G21\nG0 X0 Y0 Z20\nG1 X10 F600\n  G76 P1\nG1 X0\nM2\n"


def folder_of(case):
    return pathlib.Path(case.enterContext(tempfile.TemporaryDirectory(prefix="rmac files äö ")))


def file_of(case, content, name="Träger 1 (neu).ngc"):
    """In a folder of its own, whose name has spaces and umlauts, too."""
    file = folder_of(case) / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return file


def lines(count):
    """Of a program that is long rather than anything else."""
    moves = "".join(f"G1 X{number % 40}.5 Y{number % 37} F1000\n" for number in range(count))
    return f"G21\nG0 X0 Y0 Z20\n{moves}M2\n"
