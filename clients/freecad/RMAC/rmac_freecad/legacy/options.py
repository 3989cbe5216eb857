"""What a program does not say, as options of `rmac import`."""

import math
import pathlib
import re
import shlex
from dataclasses import dataclass

from rmac_freecad.legacy.refusal import CodeRefused

LANGUAGES = {"by the file's ending": "", "RS274/NGC": "rs274", "Fanuc": "fanuc", "Haas": "haas", "APT": "apt"}
UNITS = {"as the program says": "", "mm": "mm", "inch": "inch"}
ENDINGS = {".ngc": "rs274", ".nc": "rs274", ".tap": "rs274", ".apt": "apt", ".cls": "apt", ".aptsource": "apt"}
# Those that a document may bring with it: none of them names a file that would be written.
FURTHER = ("--tolerance", "--offset", "--reference-point", "--second-reference-point", "--output", "--input", "--output-limit",
           "--tool-diameter", "--multax", "--circle-axis", "--whole-numbers", "--variable", "--pass-over", "--rotary", "--rotary-centre",
           "--rotary-way", "--rotary-diameter", "--assume-end")  # fmt: skip
NUMBER = re.compile(r"-[\d.]")


@dataclass(frozen=True)
class Options:
    dialect: str = ""  # rs274, fanuc, haas or apt; empty: by the file's ending
    unit: str = ""  # mm or inch, where the program does not say it
    rapid_mm_min: float = 3000.0  # of G0 and RAPID; at most what the machine may go
    approach: str = ""  # X,Y,Z in mm
    assume_g43: bool = False
    block_delete: bool = False
    further: str = ""  # as on the command line

    def words(self, name, fastest_mm_min=math.inf):
        """For a file of that name, on a machine that is so fast."""
        words = ["--dialect", self.dialect_of(name), f"--rapid={min(self.rapid_mm_min, fastest_mm_min):.10g}"]
        if self.unit:
            words += ["--unit", self.unit]
        if self.approach.strip():
            words.append(f"--approach={self.approach.strip()}")
        if self.assume_g43:
            words.append("--assume-g43")
        if self.block_delete:
            words.append("--block-delete")
        return words + self._further()

    def dialect_of(self, name):
        dialect = self.dialect or ENDINGS.get(pathlib.PurePath(name).suffix.lower())
        if dialect is None:
            raise CodeRefused("its ending does not say which language it is in; choose RS274/NGC, Fanuc, Haas or APT", name)
        return dialect

    def _further(self):
        try:
            words = shlex.split(self.further)
        except ValueError as error:
            raise CodeRefused(f"further options: {error}") from error
        for number, word in enumerate(words):
            is_option = word.startswith("-") and not NUMBER.match(word)
            if (is_option or number == 0) and word.split("=", 1)[0] not in FURTHER:
                raise CodeRefused(f"further options: {word} is none of {', '.join(FURTHER)}")
        return words
