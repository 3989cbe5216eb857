"""Loops in the order in which they are cut: chains that go from loop to loop by a straight step, across walls nowhere."""

import math
from dataclasses import dataclass, replace

import numpy as np

from rmac_freecad.pockets.area import missed, swath
from rmac_freecad.pockets.levels import Loop, loops_at
from rmac_freecad.pockets.refusal import PocketRefused

ON_MM = 1e-5
MOST_LEVELS = 2000


def cleared(outline, radius, step_over):
    """Levels of loops, from the walls inwards, that leave nothing between them; and the spots that they leave nevertheless."""
    levels = []
    while True:
        loops = loops_at(outline.contours, outline.wall, radius + step_over * len(levels))
        if not loops:
            break
        if len(levels) >= MOST_LEVELS:
            raise PocketRefused(f"more than {MOST_LEVELS} loops would be needed; give a larger step-over")
        levels.append(loops)
    if not levels:
        raise PocketRefused(f"a tool with a radius of {radius:.4g} mm does not get into it anywhere; take a smaller one")
    spots = missed(outline, levels, radius) if step_over > radius else []
    if spots:
        levels = _completed(outline, levels, np.concatenate([spot.within for spot in spots]), radius)
        spots = missed(outline, levels, radius)
    return _worthwhile(levels, radius), spots


def _completed(outline, levels, places, radius):
    """With loops halfway between two levels where these leave something: it is at most half a step away from there, which is less than the
    tool's radius."""
    away = outline.wall.nearest(places)[1]
    step, made = levels[1][0].distance - levels[0][0].distance if len(levels) > 1 else 2 * radius, []
    for level in levels:
        made.append(level)
        distance = level[0].distance
        left = places[(away > distance) & (away < distance + step)]
        if len(left):
            between = loops_at(outline.contours, outline.wall, distance + step / 2)
            made.append([loop for loop in between if (swath([loop]).nearest(left)[1] <= radius).any()])
    return [level for level in made if level]


def _worthwhile(levels, radius):
    """Without those so small that the level outside of them clears all that is in them: they would be a plunge each."""
    made = levels[:1]
    for outer, level in zip(levels, levels[1:]):
        gap = level[0].distance - outer[0].distance
        made.append([loop for loop in level if loop.length / math.tau > radius - gap])
    return [level for level in made if level]


@dataclass(frozen=True, eq=False)
class Seamed:
    """A loop that begins and ends at its first track's begin."""

    loop: Loop

    @property
    def seam(self):
        return tuple(map(float, self.loop.tracks[0].at(0.0)))

    def turned(self):
        return Seamed(replace(self.loop, tracks=tuple(track.turned() for track in reversed(self.loop.tracks))))


def chains_of(outline, levels, seam):
    """Lists of `Seamed`, from the innermost loop of each outwards, those within others first. Each begins where the step from the one before
    arrives. `seam(loop)`: where one that nothing leads to begins, a track's number and a share of it."""
    chains, joined = [], {}
    for number in range(len(levels) - 1, -1, -1):
        for loop in levels[number]:
            if loop in joined:
                continue
            first = seamed(loop, *seam(loop))
            chain = [first]
            at = number
            while at > 0:
                step = _step(outline, levels, at, chain[-1].seam)
                if step is None or step[1] in joined:
                    break
                at, outer, track, share = step
                joined[outer] = True
                chain.append(seamed(outer, track, share))
            joined[loop] = True
            chains.append(chain)
    return sorted(chains, key=lambda chain: -chain[-1].loop.distance)


def _step(outline, levels, number, seam):
    """Straight towards the nearest wall, to the next loop there; all of that way is in the pocket."""
    foot, away = (found[0] for found in outline.wall.nearest([seam]))
    for at in range(number - 1, -1, -1):
        distance = levels[at][0].distance
        place = foot + (np.array(seam) - foot) * distance / away
        for loop in levels[at]:
            for track, one in enumerate(loop.tracks):
                share = one.share_at(place)
                if np.hypot(*(one.at(share) - place)) < ON_MM:
                    return at, loop, track, share
    return None


def seamed(loop, number, share):
    tracks = loop.tracks
    track, least = tracks[number], 10 * ON_MM
    if share * track.length < least:
        return Seamed(replace(loop, tracks=tracks[number:] + tracks[:number]))
    if (1 - share) * track.length < least:
        number = (number + 1) % len(tracks)
        return Seamed(replace(loop, tracks=tracks[number:] + tracks[:number]))
    return Seamed(replace(loop, tracks=(track.between(share, 1.0), *tracks[number + 1 :], *tracks[:number], track.between(0.0, share))))


def middles(loop):
    """Of its tracks, the longest first."""
    order = sorted(range(len(loop.tracks)), key=lambda i: -loop.tracks[i].length)
    return [(i, share) for i in order for share in (0.5, 0.25, 0.75)]


def cut_from(tracks, behind):
    """The last part of a loop, so long; several turns of it where it is longer."""
    whole = sum(track.length for track in tracks)
    turns, rest = divmod(behind, whole)
    found = list(tracks) * int(turns)
    part = []
    for track in reversed(tracks):
        if rest <= ON_MM:
            break
        if track.length <= rest:
            part.insert(0, track)
            rest -= track.length
        else:
            part.insert(0, track.between(track.share_behind(track.length - rest), 1.0))
            rest = 0
    return part + found


def slope_length(depth, angle_deg):
    return depth / math.tan(math.radians(angle_deg))
