"""The window: nothing in here is needed without one, and nothing in here waits for the appliance."""

from rmac_freecad.window.workbench import RmacWorkbench, add_preferences

__all__ = ["RmacWorkbench", "add_preferences"]
