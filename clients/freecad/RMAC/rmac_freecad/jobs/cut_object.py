"""What all objects of a document have that are cut without a Path job: pockets, swept faces, profiles of edges, holes."""

from rmac_freecad.jobs.table import JobTool


class CutObject:
    """Their proxy, as FreeCAD wants one. `last` is what was planned last, with what it was planned from; it is saved with no document."""

    def __init__(self, feature):
        self.last = None
        feature.Proxy = self

    def execute(self, feature):
        """Its path may take longer: the view has it made by a thread. An error is shown at the object."""
        self.last = None
        view = getattr(feature, "ViewObject", None)
        if view is not None and view.Proxy is not None:
            view.Proxy.read_soon()
        self.check(feature)

    def check(self, feature):
        """Raises for values from which nothing can be planned, as far as that is known at once."""
        raise NotImplementedError

    def tool(self, feature):
        return JobTool(feature.Tool, feature.Label, feature.Diameter.Value / 2)

    def __getstate__(self):
        return None

    def __setstate__(self, state):
        self.last = None


def add_cut_object(document, kind, proxy, group, properties):
    """A new one with its properties: name, type, value before anybody gives one, and what it is."""
    feature = document.addObject("App::FeaturePython", kind)
    proxy(feature)
    for name, of_type, value, what in properties:
        feature.addProperty(of_type, name, group, what)
        if value is not None:
            setattr(feature, name, value)
    return feature
