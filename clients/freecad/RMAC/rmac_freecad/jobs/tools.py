"""Tool controllers, held against what would go wrong at the machine."""

from rmac_freecad.jobs.refusal import JobRefused


def check_tools(job, used):
    """`used`: each operation's label and its tool controller, or None."""
    by_number = {}
    for operation, controller in used:
        if controller is None:
            raise JobRefused(f"{operation} has no tool controller")
        if controller.SpindleDir != "None" and not controller.SpindleSpeed > 0:
            raise JobRefused(f"{controller.Label}, which {operation} uses, has the spindle speed 0; set it, or the spindle direction None")
        other = by_number.setdefault(controller.ToolNumber, controller)
        if other.Tool != controller.Tool and (_geometry(other) is None or _geometry(other) != _geometry(controller)):
            raise JobRefused(
                f"{job}: {other.Label} and {controller.Label} are different tools with one number, {controller.ToolNumber}; number them apart"
            )


def _geometry(controller):
    """Shape and lengths, None where the tool tells no diameter."""
    tool = controller.Tool
    if getattr(tool, "Diameter", None) is None:
        return None
    lengths = [name for name in getattr(tool, "PropertiesList", ()) if "Length" in tool.getTypeIdOfProperty(name) or "Angle" in tool.getTypeIdOfProperty(name)]
    shape = getattr(tool, "ShapeName", None) or getattr(tool, "BitShape", None)
    return shape, float(tool.Diameter), {name: str(getattr(tool, name)) for name in lengths}
