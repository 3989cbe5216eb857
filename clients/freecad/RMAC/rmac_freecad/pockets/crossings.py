"""Where tracks cross, as shares of both."""

import math

import numpy as np

from rmac_freecad.pockets.tracks import LineTrack, SideTrack
from rmac_freecad.profiles.pieces import FULL

SLACK_MM = 1e-7  # beyond an end, which still is the end


def crossings(a, b):
    """Pairs of shares; of tracks that lie upon each other none."""
    if isinstance(a, SideTrack) or isinstance(b, SideTrack):
        return _sought(a, b)
    if isinstance(a, LineTrack) and isinstance(b, LineTrack):
        places = _two_lines(a.piece, b.piece)
    elif isinstance(a, LineTrack):
        places = _line_circle(a.piece, b.piece)
    elif isinstance(b, LineTrack):
        places = _line_circle(b.piece, a.piece)
    else:
        places = _two_circles(a.piece, b.piece)
    shares = [(_share(a, place), _share(b, place)) for place in places]
    return [pair for pair in shares if None not in pair]


def _share(track, place):
    """None beyond its ends."""
    if isinstance(track, LineTrack):
        (ax, ay), (bx, by) = track.piece.start, track.piece.end
        part = ((place[0] - ax) * (bx - ax) + (place[1] - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
    else:
        bow = track.piece
        way = math.copysign(1, bow.sweep) * (math.atan2(place[1] - bow.centre[1], place[0] - bow.centre[0]) - bow.angle) % FULL
        slack = SLACK_MM / bow.radius
        part = (way if way <= abs(bow.sweep) + slack or way < FULL - slack else way - FULL) / abs(bow.sweep)
    slack = SLACK_MM / track.length
    return min(max(part, 0.0), 1.0) if -slack <= part <= 1 + slack else None


def _two_lines(a, b):
    (px, py), (qx, qy) = a.start, b.start
    ux, uy, vx, vy = a.end[0] - px, a.end[1] - py, b.end[0] - qx, b.end[1] - qy
    turn = ux * vy - uy * vx
    if abs(turn) < 1e-12 * math.hypot(ux, uy) * math.hypot(vx, vy):
        return []
    t = ((qx - px) * vy - (qy - py) * vx) / turn
    return [(px + t * ux, py + t * uy)]


def _line_circle(line, bow):
    length = line.length
    ux, uy = (line.end[0] - line.start[0]) / length, (line.end[1] - line.start[1]) / length
    cx, cy = bow.centre[0] - line.start[0], bow.centre[1] - line.start[1]
    foot, off = cx * ux + cy * uy, ux * cy - uy * cx
    return _both_sides((line.start[0] + foot * ux, line.start[1] + foot * uy), (ux, uy), bow.radius, abs(off))


def _two_circles(a, b):
    dx, dy = b.centre[0] - a.centre[0], b.centre[1] - a.centre[1]
    distance = math.hypot(dx, dy)
    if distance < SLACK_MM:
        return []
    ux, uy = dx / distance, dy / distance
    foot = (distance**2 + a.radius**2 - b.radius**2) / (2 * distance)
    return _both_sides((a.centre[0] + foot * ux, a.centre[1] + foot * uy), (-uy, ux), a.radius, abs(foot))


def _both_sides(foot, along, radius, off):
    """A circle that is touched rather than crossed is touched in one place."""
    if off > radius + SLACK_MM:
        return []
    half = math.sqrt(max((radius - off) * (radius + off), 0))
    return [(foot[0] + side * half * along[0], foot[1] + side * half * along[1]) for side in (1, -1)]


def _sought(a, b):
    """By chords, and Newton's method from there."""
    p, q = a.chords(), b.chords()
    u, v = np.diff(p, axis=0), np.diff(q, axis=0)
    between = q[None, :-1] - p[:-1, None]
    turn = u[:, None, 0] * v[None, :, 1] - u[:, None, 1] * v[None, :, 0]
    safe = np.where(turn == 0, np.inf, turn)
    s = (between[..., 0] * v[None, :, 1] - between[..., 1] * v[None, :, 0]) / safe
    t = (between[..., 0] * u[:, None, 1] - between[..., 1] * u[:, None, 0]) / safe
    near = (s > -0.1) & (s < 1.1) & (t > -0.1) & (t < 1.1) & (turn != 0)
    found = []
    for i, j in np.argwhere(near):
        pair = _refined(a, b, _share_of(a, (i + s[i, j]) / len(u)), _share_of(b, (j + t[i, j]) / len(v)))
        if pair is not None and not any(abs(pair[0] - x) * a.length < SLACK_MM for x, _ in found):
            found.append(pair)
    return found


def _share_of(track, chord):
    """From how far along its chords."""
    return (1 - math.cos(math.pi * min(max(chord, 0), 1))) / 2 if isinstance(track, SideTrack) else chord


def _refined(a, b, s, t):
    for _ in range(30):
        s, t = min(max(s, -0.05), 1.05), min(max(t, -0.05), 1.05)
        (p, du), (q, dv) = a.course(s), b.course(t)
        off = q - p
        turn = du[0] * dv[1] - du[1] * dv[0]
        if turn == 0:
            return None
        ds, dt = (off[0] * dv[1] - off[1] * dv[0]) / turn, (off[0] * du[1] - off[1] * du[0]) / turn
        s, t = s + ds, t + dt
        if abs(ds) + abs(dt) < 1e-14:
            break
    slack_s, slack_t = SLACK_MM / a.length, SLACK_MM / b.length
    if not (-slack_s <= s <= 1 + slack_s and -slack_t <= t <= 1 + slack_t):
        return None
    s, t = min(max(s, 0.0), 1.0), min(max(t, 0.0), 1.0)
    return (s, t) if math.dist(a.at(s), b.at(t)) < 1e-6 else None
