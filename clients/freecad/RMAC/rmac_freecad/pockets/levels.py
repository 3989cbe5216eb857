"""The places that are so far from the walls of a pocket: closed loops of lines, arcs and parallels of splines, each exactly there."""

import math
from dataclasses import dataclass

import numpy as np

from rmac_freecad.pockets.crossings import crossings
from rmac_freecad.pockets.refusal import PocketRefused
from rmac_freecad.pockets.spline import ranges
from rmac_freecad.pockets.tracks import ArcTrack, LineTrack, SideTrack
from rmac_freecad.profiles.pieces import Bow, Spline, Straight, cross, dot, left_of, plus

TANGENT_RAD = 1e-7
CUSP_RAD = 1e-6
NEARER_MM = 1e-6  # to a wall than wanted is rounding
HARMLESS_MM = 2e-4  # where splines bend as much as that, their cusps are hardly apart from what crosses them
NUDGES_MM = (0.0, 1e-4, 2.7e-4, 6e-4)
JOINED_MM = 2e-6
TAIL_MM = 0.01
SHORTEST_MM = 1e-7
LOOKED_AT = (0.5, 0.03, 0.97)


@dataclass(frozen=True, eq=False)
class Loop:
    """The pocket's middle is to its left. `distance` from the walls, mm."""

    tracks: tuple
    distance: float

    @property
    def length(self):
        return sum(track.length for track in self.tracks)

    def chords(self):
        return np.concatenate([track.chords() for track in self.tracks])


def loops_at(contours, wall, distance):
    """`contours`: closed ones with the pocket to their left, of `wall`. None where nothing of it is so far away. Where walls bend just as
    much as that, it is tried again a little further away, less than a micrometre."""
    for further in NUDGES_MM:
        try:
            return _loops_at(contours, wall, distance + further)
        except PocketRefused:
            if further == NUDGES_MM[-1]:
                raise
    return []


def _loops_at(contours, wall, distance):
    tracks = [track for contour in contours for track in _raw(contour, wall, distance)]
    kept = [part for part in _parts(tracks) if _is_clear(part, wall, distance)]
    return [Loop(tuple(chain), distance) for chain in _chains(kept)]


def _raw(contour, wall, distance):
    """Beside each piece, and around corners that stand out into the pocket."""
    tracks, pieces = [], contour.pieces
    for number, piece in enumerate(pieces):
        tracks += _beside(piece, wall, distance)
        after = pieces[(number + 1) % len(pieces)]
        into, out = piece.tangents[1], after.tangents[0]
        turn = math.atan2(cross(into, out), dot(into, out))
        if math.pi - abs(turn) < CUSP_RAD:
            turn = _turn_of_cusp(piece, after, wall)
        if turn < -TANGENT_RAD:
            across = left_of(into)
            tracks.append(ArcTrack(Bow(piece.name, piece.end, distance, math.atan2(across[1], across[0]), turn)))
    return tracks


def _turn_of_cusp(piece, after, wall):
    """Whether the pocket, or what stands in it, ends in a point there: by how both sides bend."""
    bend = _bend(piece, wall, -1) + _bend(after, wall, 0)
    if bend == 0:
        raise PocketRefused("the wall turns back on itself there", piece.end, piece.name)
    return math.pi if bend < 0 else -math.pi


def _bend(piece, wall, end):
    """More than 0 where it turns left."""
    if isinstance(piece, Straight):
        return 0.0
    if isinstance(piece, Bow):
        return math.copysign(1 / piece.radius, piece.sweep)
    spline = wall.splines[id(piece)]
    return float(spline.bend(spline.t[[end]])[3][0])


def _beside(piece, wall, distance):
    if isinstance(piece, Straight):
        across = left_of(piece.tangents[0])
        return [LineTrack(Straight(piece.name, plus(piece.start, across, distance), plus(piece.end, across, distance)))]
    if isinstance(piece, Bow):
        radius = piece.radius - math.copysign(distance, piece.sweep)
        return [ArcTrack(Bow(piece.name, piece.centre, radius, piece.angle, piece.sweep))] if radius > SHORTEST_MM else []
    assert isinstance(piece, Spline)
    spline = wall.splines[id(piece)]
    return [SideTrack(piece.name, spline, first, last, distance) for first, last in ranges(spline, distance)]


def _parts(tracks):
    """Cut wherever two of them cross."""
    boxes = np.array([(*track.chords().min(0), *track.chords().max(0)) for track in tracks]).reshape(-1, 4)
    margin = np.array([track.length * 0.02 if not track.straight else 0 for track in tracks]) + 2 * SHORTEST_MM
    low, high = boxes[:, :2] - margin[:, None], boxes[:, 2:] + margin[:, None]
    cuts = [[0.0, 1.0] for _ in tracks]
    for i in range(len(tracks)):
        meets = ((low[i] <= high[i + 1 :]) & (low[i + 1 :] <= high[i])).all(1)
        for j in np.flatnonzero(meets) + i + 1:
            for s, t in crossings(tracks[i], tracks[j]):
                cuts[i].append(s)
                cuts[j].append(t)
    for track, shares in zip(tracks, cuts):
        shares.sort()
        for first, last in zip(shares, shares[1:]):
            if (last - first) * track.length > SHORTEST_MM:
                yield track.between(first, last)


def _is_clear(part, wall, distance):
    """Between two crossings it is nearer to a wall everywhere, or nowhere."""
    _, away = wall.nearest(part.at(np.array(LOOKED_AT)))
    if away[0] < distance - NEARER_MM:
        return False
    if (distance - away).max() > HARMLESS_MM:
        place = tuple(map(float, part.at(0.5)))
        raise PocketRefused(f"the way {distance:.4g} mm beside the walls cannot be told apart there; move that wall a little, or take another tool", place, part.name)
    return True


def _chains(tracks):
    """Joined end to begin. Each place has as many ends as begins, else something was missed: refused rather than guessed."""
    nodes, begins, ends = _nodes(tracks)
    kept = [i for i in range(len(tracks)) if begins[i] != ends[i] or tracks[i].length > 10 * JOINED_MM]
    kept = _without_tails(kept, tracks, begins, ends)
    outs = {}
    for i in kept:
        outs.setdefault(begins[i], []).append(i)
    for node in {*outs, *(ends[i] for i in kept)}:
        if len(outs.get(node, [])) != sum(ends[i] == node for i in kept):
            at = next(i for i in kept if node in (begins[i], ends[i]))
            raise PocketRefused("the way beside the walls does not close there; move that wall a little, or take another tool or step-over", nodes[node], tracks[at].name)
    chains = []
    while any(outs.values()):
        first = next(group for group in outs.values() if group)[0]
        chain = [first]
        outs[begins[first]].remove(first)
        while ends[chain[-1]] != begins[first]:
            chosen = min(outs[ends[chain[-1]]], key=lambda i: _turn(tracks[chain[-1]], tracks[i]))
            outs[ends[chain[-1]]].remove(chosen)
            chain.append(chosen)
        chains.append([tracks[i] for i in chain])
    return chains


def _without_tails(kept, tracks, begins, ends):
    """What is left of a cusp behind the place where it crosses itself ends nowhere, and is as near to the wall as rounding."""
    while True:
        starts, stops = {begins[i] for i in kept}, {ends[i] for i in kept}
        tails = {i for i in kept if tracks[i].length < TAIL_MM and (begins[i] not in stops or ends[i] not in starts)}
        if not tails:
            return kept
        kept = [i for i in kept if i not in tails]


def _turn(before, after):
    """Straight on first, and rather to the left."""
    into, out = before.tangent(1.0), after.tangent(0.0)
    turn = math.atan2(cross(into, out), dot(into, out))
    return round(abs(turn), 6), -turn


def _nodes(tracks):
    """Places of ends and begins; the number of that of each track's begin and end."""
    places = np.array([place for track in tracks for place in (track.at(0.0), track.at(1.0))]).reshape(-1, 2)
    number = np.full(len(places), -1)
    nodes = []
    for i, place in enumerate(places):
        if number[i] < 0:
            same = (np.abs(places - place) < JOINED_MM).all(1) & (number < 0)
            number[same] = len(nodes)
            nodes.append(tuple(place))
    return nodes, number[0::2].tolist(), number[1::2].tolist()
