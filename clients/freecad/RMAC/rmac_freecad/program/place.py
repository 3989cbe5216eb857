"""Where in a job something comes from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Place:
    operation: str  # its label in the tree
    command: int  # its number in the operation's path, from 1 as FreeCAD's "Inspect G-code" lists them
    code: str

    def __str__(self):
        return f"{self.operation}, command {self.command} ({self.code})"
