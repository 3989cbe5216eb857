"""What cannot be cut along, with the place."""


class ProfileRefused(Exception):
    """`place` is x, y in mm, or None where that is the contour as a whole."""

    def __init__(self, why, place=None, edge=""):
        where = f" at X {place[0]:.4g} Y {place[1]:.4g}" if place is not None else ""
        super().__init__(f"{edge}{where}: {why}".strip(": ") if edge or where else why)
        self.why = why
        self.place = place
        self.edge = edge
