"""A machine's picture, drawn from its description by the command-line client."""

import pathlib
import shutil
import subprocess
import tempfile


class NoPicture(Exception):
    """It says what is missing."""


def draw(machine, address, rmac="rmac", patience_s=120):
    """PNG. Only a computer that has the machine's description can draw it: the appliance's own, or one with its device tree."""
    executable = shutil.which(rmac)
    if executable is None:
        raise NoPicture(f"the program {rmac} is not there, which draws machines")
    with tempfile.TemporaryDirectory(prefix="rmac-picture-") as folder:
        file = pathlib.Path(folder) / "machine.png"
        try:
            ended = subprocess.run(
                [executable, *_where(address), "show", machine, "--plot", str(file)],
                stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=patience_s,
            )  # fmt: skip
        except subprocess.TimeoutExpired as late:
            raise NoPicture(f"drawing {machine} took longer than {patience_s} s") from late
        if ended.returncode != 0:
            raise NoPicture(ended.stderr.strip())
        return file.read_bytes()


def _where(address):
    return [f"--socket={address.path}"] if address.path else [f"--host={address.host}", f"--port={address.port}"]
