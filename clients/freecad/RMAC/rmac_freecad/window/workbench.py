"""The workbench RMAC: its toolbar is that of direct machining in the dissertation, figure 6.2."""

import FreeCADGui

from rmac_freecad.window.icons import ICONS, icon

TOOLBAR = "Direct machining"


class RmacWorkbench(FreeCADGui.Workbench):
    MenuText = "RMAC"
    ToolTip = "Machines Path jobs directly, with no post-processor between"
    Icon = icon("rmac")

    def Initialize(self):
        from rmac_freecad.window.commands import register

        names = register()
        self.appendToolbar(TOOLBAR, names)
        self.appendMenu("&RMAC", names)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


def add_preferences():
    """At FreeCAD's start: the page is there before anybody opens the workbench."""
    FreeCADGui.addIconPath(str(ICONS))
    FreeCADGui.addPreferencePage(str(ICONS.parent / "preferences.ui"), "RMAC")
