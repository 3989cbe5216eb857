"""The tools of a job, held against the tool table of a machine."""

from dataclasses import dataclass

from PathScripts import PathUtil


@dataclass(frozen=True)
class JobTool:
    number: int
    label: str  # of its tool controller
    radius_mm: float  # 0 where the tool tells none


def tools_of(job):
    """Those of operations that are switched on, each once, in the order of their use."""
    found = {}
    for operation in job.Operations.Group:
        controller = PathUtil.toolControllerForOp(operation)
        if controller is None or PathUtil.opProperty(operation, "Active") is False:
            continue
        diameter = getattr(controller.Tool, "Diameter", 0)
        found.setdefault(controller.ToolNumber, JobTool(controller.ToolNumber, controller.Label, float(diameter) / 2))
    return list(found.values())


def lacking(tools, table):
    """Those that `table`, as `client.cam.GetTools()` gives it, has not."""
    known = {tool["ToolNumber"] for tool in table["Tools"]}
    return [tool for tool in tools if tool.number not in known]


def completed(table, tools):
    """A table that has them all: those that it lacks as long as nothing, for a comparison of machines."""
    more = [{"ToolNumber": tool.number, "Length": 0, "Radius": tool.radius_mm} for tool in lacking(tools, table)]
    return {"Mounted": table["Mounted"], "Tools": [*table["Tools"], *more]}


EMPTY = {"Mounted": 0, "Tools": []}
