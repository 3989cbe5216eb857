"""Jobs as users of FreeCAD make them: a plate with a hole, its model, stock and tool controllers by FreeCAD itself."""

import FreeCAD
import Part  # noqa: F401  its types of objects
import Path
import PathScripts.PathCustom as PathCustom
import PathScripts.PathJob as PathJob


def plate_job(case):
    document = FreeCAD.newDocument("plate")
    case.addCleanup(FreeCAD.closeDocument, document.Name)
    box = document.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 40, 30, 10
    hole = document.addObject("Part::Cylinder", "Hole")
    hole.Radius, hole.Height = 4, 12
    hole.Placement.Base = FreeCAD.Vector(20, 15, -1)
    plate = document.addObject("Part::Cut", "Plate")
    plate.Base, plate.Tool = box, hole
    document.recompute()
    job = PathJob.Create("Job", [plate])
    controller = job.Tools.Group[0]
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = "600 mm/min", "100 mm/min", 3000
    document.recompute()
    return job


def operation_of(job, module, name, **properties):
    """Of one of FreeCAD's own kinds, on the whole model, or on its hole."""
    operation = module.Create(name)
    for key, value in properties.items():
        setattr(operation, key, value)
    job.Document.recompute()
    return operation


def hole_of(job):
    model = job.Model.Group[0]
    faces = [f"Face{i}" for i, face in enumerate(model.Shape.Faces, 1) if isinstance(face.Surface, Part.Cylinder)]
    return [(model, tuple(faces))]


def written(job, lines, label="Custom"):
    """An operation whose path is what `lines` say, in FreeCAD's own units: mm, and mm a second."""
    operation = PathCustom.Create(label)
    operation.Label = label
    operation.Gcode = list(lines)
    job.Document.recompute()
    set_path(operation, lines)
    return operation


def set_path(operation, lines):
    operation.Path = Path.Path([Path.Command(line) for line in lines])
    operation.purgeTouched()


def remove_operations(job):
    for operation in job.Operations.Group:
        job.Document.removeObject(operation.Name)
