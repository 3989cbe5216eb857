"""A FreeCAD that moves the machine, and is killed meanwhile: freecadcmd runs it with RMAC_ADDRESS, and RMAC_MOVES jog, cut or measure."""

import os
import threading

import rmac_freecad  # noqa: F401  finds the package rmac
from rmac_freecad.jogging import Hand, HeldJog, axes_of
from rmac_freecad.measuring import Place, measure
from rmac_freecad.program import Place as JobPlace
from rmac_freecad.program import Program
from rmac_freecad.running import cut
from rmac_freecad.station import Station

import rmac  # isort: skip

TICK_S = 0.05


def jog(connect):
    hand = Hand(connect)
    held = HeldJog(lambda: hand.client().call, print)
    axis = axes_of(hand.client().machine())[0]
    while not threading.Event().wait(TICK_S):  # as the window's timer ticks
        held.hold(axis, 2, moving=False)


def machine(connect):
    program = Program()
    place = JobPlace("Operation", 1, "G1")
    for move in (rmac.calls.RMAC_CAM.SetFeedrate(60), rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (40, 0, 0))):
        program.append(move, place)
    client = connect()
    with client.authority():
        list(cut(client, program))


def touch(connect):
    far = Place("Face1", (40.0, 0.0, -20.0), (0.0, 0.0, 1.0))
    measure(connect(), [far], tip_radius_mm=1, clearance_mm=2, safe_mm=0, speed_mm_s=1)


station = Station("dying")
{"jog": jog, "cut": machine, "measure": touch}[os.environ["RMAC_MOVES"]](lambda: station.connect(os.environ["RMAC_ADDRESS"]))
