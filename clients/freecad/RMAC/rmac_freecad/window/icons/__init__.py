"""Pictures of the toolbar."""

import pathlib

ICONS = pathlib.Path(__file__).parent


def icon(name):
    return str(ICONS / f"{name}.svg")
