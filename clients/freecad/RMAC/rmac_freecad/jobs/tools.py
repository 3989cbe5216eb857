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
        if other.Tool != controller.Tool and _diameter(other) != _diameter(controller):
            raise JobRefused(
                f"{job}: {other.Label} and {controller.Label} are different tools with one number, {controller.ToolNumber}; number them apart"
            )


def _diameter(controller):
    diameter = getattr(controller.Tool, "Diameter", None)
    return None if diameter is None else float(diameter)
