"""A file of another control, byte for byte."""

import base64
import functools
import hashlib
import pathlib
import zlib
from dataclasses import dataclass

from rmac_freecad.legacy.refusal import CodeRefused

MOST_BYTES = 1 << 28


@dataclass(frozen=True)
class Source:
    path: str  # where it was
    content: bytes

    @property
    def name(self):
        return pathlib.PurePath(self.path.replace("\\", "/")).name  # a document of a Windows computer has its separators

    @functools.cached_property
    def sha256(self):
        return hashlib.sha256(self.content).hexdigest()

    @functools.cached_property
    def packed(self):
        """As a text: a property of FreeCAD that holds a file loses it when two objects have one of the same name."""
        return base64.b64encode(zlib.compress(self.content, 1)).decode("ascii")

    @classmethod
    def unpacked(cls, path, text):
        inflater = zlib.decompressobj()
        try:
            content = inflater.decompress(base64.b64decode(text, validate=True), MOST_BYTES)
        except (ValueError, zlib.error) as damaged:
            raise CodeRefused("what the document keeps of it is damaged; open the file again", cls(path, b"").name) from damaged
        if not inflater.eof:
            raise CodeRefused("what the document keeps of it is damaged or too long; open the file again", cls(path, b"").name)
        return cls(path, content)


def read_source(path):
    """Waits for the file."""
    file = pathlib.Path(path).expanduser()
    name = file.name or str(path)
    if not file.is_file():  # nobody waits for a pipe or a device
        raise CodeRefused("there is no file of this name; it may have been moved or deleted", name)
    if file.stat().st_size > MOST_BYTES:
        raise CodeRefused(f"it has more than {MOST_BYTES >> 20} MB; run it by rmac run, or cut it into parts", name)
    try:
        content = file.read_bytes()
    except OSError as error:
        raise CodeRefused(f"it cannot be read: {error.strerror}", name) from error
    if not content.strip(b"\xef\xbb\xbf \t\r\n\0"):
        raise CodeRefused("it is empty", name)
    source = Source(str(file.absolute()), content)
    source.packed  # takes its time, and whoever reads has it
    return source


def check_unchanged(source):
    """Against the file that it came from, where that is still there: on another computer it hardly is."""
    try:
        now = read_source(source.path)
    except CodeRefused:
        return
    if now.content != source.content:
        raise CodeRefused(
            f"it was changed since it was opened: open it again by Open legacy code. To machine what the document keeps, empty the property File of the object ({source.path})",
            source.name,
        )
