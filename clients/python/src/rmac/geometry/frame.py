"""Rigid frames, as links and bodies of a machine have them."""

from __future__ import annotations

from typing import Any, NamedTuple

from rmac.geometry.pose import Point

Quaternion = tuple[float, float, float, float]


class Frame(NamedTuple):
    """`p` in mm, and `q`, a unit quaternion w x y z that turns what is in this frame into the one around it."""

    p: Point = (0.0, 0.0, 0.0)
    q: Quaternion = (1.0, 0.0, 0.0, 0.0)

    def point(self, inner: Point) -> Point:
        """A point of this frame, in the one around it."""
        w, x, y, z = self.q
        a, b, c = inner
        u, v, t = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
        return (
            self.p[0] + a + w * u + y * t - z * v,
            self.p[1] + b + w * v + z * u - x * t,
            self.p[2] + c + w * t + x * v - y * u,
        )

    def times(self, inner: Frame) -> Frame:
        """A frame that stands in this one, in the one around it."""
        w, x, y, z = self.q
        a, b, c, d = inner.q
        turned = (
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        )
        return Frame(self.point(inner.p), turned)

    def inverse(self) -> Frame:
        w, x, y, z = self.q
        back = Frame((0.0, 0.0, 0.0), (w, -x, -y, -z))
        a, b, c = back.point(self.p)
        return Frame((-a, -b, -c), back.q)

    def wire(self) -> dict[str, object]:
        return {"p": self.p, "q": self.q}


def read_frame(told: Any) -> Frame:
    """As the appliance gives it."""
    x, y, z = told["p"]
    a, b, c, d = told["q"]
    return Frame((x, y, z), (a, b, c, d))
