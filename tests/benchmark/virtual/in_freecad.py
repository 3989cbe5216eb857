"""FreeCAD runs this file: its Path simulator, the C++ class behind the window, over the program of waves.py. Writes what that took and the corners
of the surface to the file that RMAC_BENCH_RESULT names."""

import os
import resource
import sys

import FreeCAD
import numpy as np
import Part
import Path
import PathSimulator

sys.path.insert(0, os.path.join(os.environ["RMAC_SOURCE"], "tests/benchmark/virtual"))
import waves  # noqa: E402

PROFILE_MM = 0.005  # to which the tool's shape is read, as the window has it


def cpu_s():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def shapes():
    size, radius = waves.BLOCK, waves.RADIUS
    block = Part.makeBox(*size, FreeCAD.Vector(-size[0] / 2, -size[1] / 2, -size[2]))
    middle = FreeCAD.Vector(0, 0, radius)
    return block, Part.makeSphere(radius, middle).fuse(Part.makeCylinder(radius, waves.CUTS_UP_TO - radius, middle))


def main():
    block, tool = shapes()
    tips = waves.tips().tolist()
    commands = [Path.Command("G1", dict(zip("XYZ", tip, strict=True))) for tip in tips[1:]]
    simulator = PathSimulator.PathSim()
    begun = cpu_s()
    simulator.BeginSimulation(block, waves.RESOLUTION)
    simulator.SetToolShape(tool, PROFILE_MM)
    at = FreeCAD.Placement(FreeCAD.Vector(*tips[0]), FreeCAD.Rotation())
    for command in commands:
        at = simulator.ApplyCommand(at, command)
    cut = cpu_s()
    meshes = simulator.GetResultMesh()
    ended = cpu_s()
    corners = np.concatenate([np.array([facet.Points for facet in mesh.Facets]) for mesh in meshes])
    np.savez(os.environ["RMAC_BENCH_RESULT"], corners=corners, cut_s=cut - begun, surface_s=ended - cut, version=".".join(FreeCAD.Version()[:3]))


main()
