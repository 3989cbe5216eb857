"""Programs of other controls, RS274/NGC, Fanuc, Haas and APT, as objects of a document: by `rmac import`, each move with its line."""

from rmac_freecad.legacy.code import code_of, codes, is_code, open_code, options_of, read_code, reading
from rmac_freecad.legacy.importing import import_source
from rmac_freecad.legacy.options import Options
from rmac_freecad.legacy.program import CodeProgram, SourceLine, tools_in
from rmac_freecad.legacy.refusal import CodeRefused
from rmac_freecad.legacy.source import Source, read_source

__all__ = [
    "CodeProgram",
    "CodeRefused",
    "Options",
    "Source",
    "SourceLine",
    "code_of",
    "codes",
    "import_source",
    "is_code",
    "open_code",
    "options_of",
    "read_code",
    "read_source",
    "reading",
    "tools_in",
]
