"""Quarter circles that lead in to a way beside a contour, and out of it, without a mark where it begins."""

import math
from dataclasses import replace

from rmac_freecad.profiles.contour import Contour
from rmac_freecad.profiles.offset import check_clear
from rmac_freecad.profiles.pieces import Bow, Straight, left_of, plus
from rmac_freecad.profiles.refusal import ProfileRefused


def with_leads(contour, way, distance, radius):
    """`way` beside `contour` as of `beside`, with both; a closed one then begins in the middle of its longest piece. Open, since it ends
    elsewhere. Refused where the tool would cut into the contour on a lead."""
    pieces = _from_a_middle(way.pieces) if way.closed else way.pieces
    side = math.copysign(1, distance)
    into, out = _lead(pieces[0], 0, side, radius), _lead(pieces[-1], 1, side, radius)
    try:
        check_clear(contour, [into, out], abs(distance))
    except ProfileRefused as refused:
        raise ProfileRefused(f"a lead of {radius:g} mm has no room: {refused.why}, or a smaller lead", refused.place, refused.edge) from refused
    return Contour((into, *pieces, out), way.z, False)


def _from_a_middle(pieces):
    number = max(range(len(pieces)), key=lambda i: pieces[i].length)
    first, second = _halves(pieces[number])
    return (second, *pieces[number + 1 :], *pieces[:number], first)


def _halves(piece):
    if isinstance(piece, Straight):
        middle = plus(piece.start, plus(piece.end, piece.start, -1), 0.5)
        return replace(piece, end=middle), replace(piece, start=middle)
    return replace(piece, sweep=piece.sweep / 2), replace(piece, angle=piece.angle + piece.sweep / 2, sweep=piece.sweep / 2)


def _lead(piece, end, side, radius):
    """On the side that is away from the contour; tangent to the piece at its begin, or at its end."""
    place, across = (piece.start, piece.end)[end], left_of(piece.tangents[end])
    centre = plus(place, across, side * radius)
    arm = plus(place, centre, -1)
    sweep = side * math.pi / 2
    angle = math.atan2(arm[1], arm[0])
    return Bow(piece.name, centre, radius, angle - (0 if end else sweep), sweep)
