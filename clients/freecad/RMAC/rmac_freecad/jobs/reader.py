"""Carries out a path's commands, one by one. What is not understood is refused with its place."""

import math

import rmac

from rmac_freecad.jobs.arcs import PLANES
from rmac_freecad.jobs.drilling import drill
from rmac_freecad.jobs.refusal import JobRefused

# The words that each code may have. FreeCAD gives some commands a feed that they do not use.
CYCLES = {"G73": "XYZRQF", "G81": "XYZRF", "G82": "XYZRPF", "G83": "XYZRQF"}
WORDS = {"G0": "XYZF", "G1": "XYZF", "G2": "XYZIJKF", "G3": "XYZIJKF", "G4": "P", **CYCLES,
         "M3": "S", "M4": "S", "M6": "T", "G43": "H"}
ENDS_CYCLES = ("G0", "G1", "G2", "G3", "G80", "M6")
AS_IT_IS = ("G21", "G40", "G80", "G90", "G94")
SPINDLES = {"M3": 1, "M4": -1}
COOLANTS = ("M7", "M8", "M9")


class Reader:
    def __init__(self, program, mover):
        self._program = program
        self._mover = mover
        self._tool = None
        self._coolants = set()
        self.begin_operation()

    def begin_operation(self):
        """What an operation before this one left in force was its own: its feed may be another tool's."""
        self._plane = "G17"
        self._retract_to_r = False
        self._initial_z = None  # before the first of a row of canned cycles: where G98 retracts to
        self._feed = None
        self.moved = self.cut = False

    def read(self, command, place):
        code = _plain(command.Name)
        if not code or code[0] in "(;":
            return  # a comment
        words = {letter.upper(): value for letter, value in command.Parameters.items()}
        for letter, value in words.items():
            if letter not in WORDS.get(code, ""):
                raise JobRefused(f"{letter} is not understood here", place)
            if not math.isfinite(value):
                raise JobRefused(f"{letter} is no number", place)
        if code in ENDS_CYCLES:
            self._initial_z = None
        if code == "G0":
            self.moved = True
            self._mover.rapid(words, place)
        elif code in ("G1", "G2", "G3") or code in CYCLES:
            self._cut(code, words, place)
        elif not self.switch(code, place, words):
            raise JobRefused(f"{code} is not understood; take it out, or write it as G0 to G3", place)

    def _cut(self, code, words, place):
        self.moved = self.cut = True
        feed = self._feed_of(words, place)
        if code == "G1":
            self._mover.line(words, feed, place)
        elif code in CYCLES:
            if self._plane != "G17":
                raise JobRefused(f"a canned cycle in {self._plane}", place)
            if self._initial_z is None:
                self._initial_z = self._mover.start(place)[2]
            drill(self._mover, code, words, feed, None if self._retract_to_r else self._initial_z, place)
        else:
            self._mover.arc(words, self._plane, code == "G2", feed, place)

    def _feed_of(self, words, place):
        """FreeCAD's own unit is mm a second, whatever the document shows."""
        if "F" in words:
            self._feed = round(words["F"] * 60, 9)
        if self._feed is None or not self._feed > 0:
            raise JobRefused("the feed is 0; give the operation's tool controller a horizontal and a vertical feed", place)
        return self._feed

    def switch(self, code, place, words):
        """What moves nothing; whether it is understood."""
        if code in PLANES:
            self._plane = code
        elif code in ("G98", "G99"):
            self._retract_to_r = code == "G99"
        elif code == "G4":
            self._mover.dwell(self._word(words, "P", place), place)
        elif code in SPINDLES:
            speed = self._word(words, "S", place)
            if not speed > 0:
                raise JobRefused("the spindle speed is 0; set it in the tool controller", place)
            self._append(rmac.spindle(SPINDLES[code] * speed), place)
        elif code == "M5":
            self._append(rmac.spindle(0), place)
        elif code == "M6":
            self._change_tool(self._word(words, "T", place), place)
        elif code == "G43":
            if "H" in words and words["H"] != self._tool:
                raise JobRefused(f"the length of tool {words['H']:g}, which is not in the spindle", place)
        elif code in COOLANTS:
            self._coolant(code, place)
        elif code in ("M0", "M1"):
            self._append(rmac.ProgramStop(optional=code == "M1"), place)
        else:
            return code in AS_IT_IS
        return True

    def _change_tool(self, number, place):
        if number != int(number) or number < 1:
            raise JobRefused(f"a tool's number is 1 or more, and whole; this is {number:g}", place)
        if number != self._tool:
            self._append(rmac.tool_change(int(number)), place)
            self._mover.forget()
            self._tool = number

    def _coolant(self, code, place):
        calls = rmac.calls.RMAC_CAM
        if code == "M7":
            self._append(rmac.output("Mist", True), place)
            self._coolants.add(code)
        elif code == "M8":
            self._append(rmac.InTurn(calls.TurnCoolantOn()), place)
            self._coolants.add(code)
        else:
            if "M7" in self._coolants:
                self._append(rmac.output("Mist", False), place)
            if self._coolants != {"M7"}:
                self._append(rmac.InTurn(calls.TurnCoolantOff()), place)
            self._coolants.clear()

    def _word(self, words, letter, place):
        if letter not in words:
            raise JobRefused(f"it needs {letter}", place)
        return words[letter]

    def _append(self, move, place):
        self._program.append(move, place)


def _plain(name):
    """G01 is G1."""
    name = name.strip().upper()
    if name[:1] in ("G", "M") and name[1:].isdigit():
        return name[0] + str(int(name[1:]))
    return name
