"""Bodies of a machine as FreeCAD has them, each in its own frame."""

import FreeCAD
import Mesh
import Part

DOWN = FreeCAD.Vector(0, 0, -1)


def placement_of(frame):
    """Of a `rmac.Frame`."""
    w, x, y, z = frame.q
    return FreeCAD.Placement(FreeCAD.Vector(*frame.p), FreeCAD.Rotation(x, y, z, w))


def is_mesh(body):
    return "Mesh" in body.shape


def solid_of(body):
    """Of a body that is no mesh: centred on its frame, along z where it has an axis, as device.json has it."""
    ((kind, sizes),) = body.shape.items()
    if kind == "Box":
        x, y, z = sizes["Size"]
        return Part.makeBox(x, y, z, FreeCAD.Vector(-x / 2, -y / 2, -z / 2))
    if kind == "Sphere":
        return Part.makeSphere(sizes["Radius"])
    low = DOWN * (sizes["Height"] / 2)
    if kind == "Cylinder":
        return Part.makeCylinder(sizes["Radius"], sizes["Height"], low)
    return Part.makeCone(sizes["Radius"], sizes["TopRadius"], sizes["Height"], low)


def mesh_of(surface):
    """Of what `client.cam.GetMesh` gives."""
    points = [FreeCAD.Vector(*point) for point in surface["Points"]]
    return Mesh.Mesh([tuple(points[corner]) for triangle in surface["Triangles"] for corner in triangle])


def colour_of(body):
    """Red, green and blue up to 1; None where the body has none."""
    if not body.colour:
        return None
    return tuple(int(body.colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
