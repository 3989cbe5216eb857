"""Has `rmac import` read a file of another control."""

import math
import pathlib
import re
import shutil
import subprocess
import tempfile

from rmac_freecad.legacy.program import CodeProgram
from rmac_freecad.legacy.refusal import CodeRefused
from rmac_freecad.simulation import NoProgram

LINE_COLUMN = re.compile(r"(\d+):(\d+): (.*)", re.S)


def import_source(source, options, fastest_mm_min=math.inf, rmac="rmac", watch=lambda program: None):
    """Takes its time; touches no document. Raises `CodeRefused`, and `NoProgram` without the command-line client `rmac`. `watch` is
    given the program before it grows."""
    words = options.words(source.name, fastest_mm_min)
    executable = shutil.which(rmac)
    if executable is None:
        raise NoProgram(f"the program {rmac} is not there; it comes with the appliance's package, or give its path as rmac=")
    with tempfile.TemporaryDirectory(prefix="rmac-import-") as folder:
        file, said = pathlib.Path(folder) / "source", pathlib.Path(folder) / "said"
        file.write_bytes(source.content)
        program = CodeProgram(source.name)
        watch(program)
        with said.open("wb") as errors, subprocess.Popen(
            [executable, "import", str(file), "-o", "-", "--ids-are-lines", *words],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=errors,
        ) as importer:  # fmt: skip
            try:
                for request in importer.stdout:
                    program.append_request(request)
            except BaseException:
                importer.kill()  # it would wait for ever for somebody who reads
                raise
        if importer.returncode != 0:
            raise _refusal(said.read_text(errors="replace"), str(file), source)
    if not any(program.method_of(index).startswith("RMAC_CAM.Move") for index in range(len(program))):
        raise CodeRefused("nothing in it moves the tool", source.name)
    return program


def _refusal(said, file, source):
    told = said.strip().removeprefix("rmac-import: ").removeprefix(f"{file}:").strip()
    place = LINE_COLUMN.fullmatch(told)
    if place is None:
        return CodeRefused(told.replace("Run with --help for more information.", "").strip() or "rmac import ended without a word", source.name)
    return CodeRefused(place[3], source.name, max(int(place[1]), 1), int(place[2]))
