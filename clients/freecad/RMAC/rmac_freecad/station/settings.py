"""What the preferences say, as FreeCAD keeps them."""

import pathlib
import shutil

import FreeCAD

GROUP = "User parameter:BaseApp/Preferences/Mod/RMAC"
ADDRESS = "localhost:7402"
IN_CHECKOUT = pathlib.Path(__file__).resolve().parents[5] / "build/release/bin/rmac"


class Settings:
    """Read anew each time: the page of preferences may have changed them."""

    def __init__(self, group=GROUP):
        self._group = FreeCAD.ParamGet(group)

    @property
    def address(self):
        """`host:port`, or `unix:` and the path of the appliance's socket."""
        return self._group.GetString("Address", "").strip() or ADDRESS

    @address.setter
    def address(self, address):
        self._group.SetString("Address", address.strip())

    @property
    def rmac(self):
        """The command-line client, which simulates: as the preferences name it, on the path, or beside this add-on in a checkout."""
        named = self._group.GetString("Program", "").strip()
        if named:
            return named
        return shutil.which("rmac") or (str(IN_CHECKOUT) if IN_CHECKOUT.is_file() else "rmac")

    @rmac.setter
    def rmac(self, program):
        self._group.SetString("Program", program)
