"""The objects of a document that are a machine's bodies."""

import FreeCAD
import Part

from rmac_freecad.animation.solids import colour_of, is_mesh, mesh_of, placement_of, solid_of

ABOUT_PART = "part"  # the part stands where it is drawn, and the machine moves about it
ABOUT_BASE = "base"  # the machine stands, and its table moves
TIP = "Tool tip"


class MachineModel:
    """A group with an object for each body, and the tool's tip as a point. By the thread of the document."""

    def __init__(self, document, geometry, meshes, about=ABOUT_PART):
        """`meshes`: what `GetMesh` gave, by the names of the bodies; those that it lacks are left out."""
        if about not in (ABOUT_PART, ABOUT_BASE):
            raise ValueError(f"a machine moves about the {ABOUT_PART} or the {ABOUT_BASE}, not {about!r}")
        self.geometry = geometry
        self._document, self._about = document.Name, about
        group = document.addObject("App::DocumentObjectGroup", "Machine")
        group.Label = geometry.machine
        self._group = group.Name
        self._bodies = [(body, group.newObject(*_kind_of(body)).Name) for body in geometry.bodies if not is_mesh(body) or body.name in meshes]
        for body, name in self._bodies:
            self._fill(document.getObject(name), body, meshes)
        tip = group.newObject("Part::Feature", "Tip")
        tip.Label = TIP
        tip.Shape = Part.Vertex(0, 0, 0)
        self._tip = tip.Name

    @property
    def objects(self):
        """By the names of the bodies, and `TIP`."""
        document = FreeCAD.getDocument(self._document)
        return {body.name: document.getObject(name) for body, name in self._bodies} | {TIP: document.getObject(self._tip)}

    @property
    def there(self):
        """Whether somebody closed the document or took its objects away."""
        if self._document not in FreeCAD.listDocuments():
            return False
        document = FreeCAD.getDocument(self._document)
        return all(document.getObject(name) is not None for name in [self._group, self._tip, *(name for _, name in self._bodies)])

    def place(self, animation, sample):
        """As the links stand in a sample of an animation of this machine."""
        document = FreeCAD.getDocument(self._document)
        around = animation.part(sample).inverse() if self._about == ABOUT_PART else None
        for body, name in self._bodies:
            self._put(document.getObject(name), around, sample.links[body.link].times(body.pose))
        self._put(document.getObject(self._tip), around, animation.tip(sample, self.geometry))

    def remove(self):
        if self._document not in FreeCAD.listDocuments():
            return
        document = FreeCAD.getDocument(self._document)
        for name in [self._tip, *(name for _, name in self._bodies), self._group]:
            if document.getObject(name) is not None:
                document.removeObject(name)

    def _fill(self, made, body, meshes):
        made.Label = body.name
        if is_mesh(body):
            made.Mesh = mesh_of(meshes[body.name])
        else:
            made.Shape = solid_of(body)
        made.Placement = placement_of(body.pose)
        colour = colour_of(body)
        if FreeCAD.GuiUp and colour is not None:
            made.ViewObject.ShapeColor = colour

    def _put(self, made, around, frame):
        made.Placement = placement_of(frame if around is None else around.times(frame))
        made.purgeTouched()  # nothing is to be computed anew


def draw_machine(client, document, about=ABOUT_PART):
    """The machine that is loaded, with all joints at 0. `ValueError` says what is missing where there is nothing to draw."""
    geometry = client.geometry()
    if not geometry.bodies:
        raise ValueError(geometry.missing)
    return MachineModel(document, geometry, surfaces_of(client, geometry), about)


def surfaces_of(client, geometry):
    """Of the bodies that are meshes. Waits: for a thread of the station."""
    import rmac

    found = {}
    for body in geometry.bodies:
        if is_mesh(body):
            try:
                found[body.name] = client.cam.GetMesh(body.name)
            except rmac.Refused as refused:
                FreeCAD.Console.PrintWarning(f"RMAC: {body.name} is not drawn: {refused.message}\n")
    return found


def _kind_of(body):
    return ("Mesh::Feature" if is_mesh(body) else "Part::Feature", "Body")
