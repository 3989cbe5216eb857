"""The axis along a pass: by lead and tilt against the normal, and where the mill would touch the part so, by the nearest angles at
which it passes."""

import math

import numpy as np

from rmac_freecad.surfaces.five.lean import MOST

STEPS = ((None, 5.0), (10.0, 10.0), (5.0, 5.0))  # degrees from lead to lead and from tilt to tilt, each where those before do not do
SPARE = 0.03  # radii that the side keeps off the part where angles change
EVERY = ((3, 2), (1, 2), (1, 0))  # samples from place to place where angles are chosen, and how often these are evened out
OFF_COST, TURN_COST = 15.0, 5.0  # degrees off what was asked for, and of a turn from place to place, that cost the same
WINDOW = 3  # of these, over which angles are evened out


class Axes:
    def __init__(self, lean, access):
        self.lean, self._access = lean, access
        self._wanted = np.array([lean.lead, lean.tilt])
        self._grids = [] if lean.axis is not None else [_grid(lean, lead_step, tilt_step) for lead_step, tilt_step in STEPS]

    @property
    def barred(self):
        """Why the ball alone gets to a place."""
        way, near = ("the axis that was given", 0.0) if self.lean.axis is not None else ("any axis that does not point down", SPARE)
        return f"out of reach: the mill's side, up to the spindle, would touch the part, or pass it by less than {self._access.margin_mm(near):.3g} mm, with {way}"

    def angles(self, places, wanted):
        """Leads and tilts at each place that is wanted; nan where the mill does not pass at any."""
        found = np.full((len(wanted), 2), np.nan)
        asked = np.flatnonzero(wanted)
        axes = self.lean.axes(places.normal[asked], places.feed[asked], np.broadcast_to(self._wanted, (len(asked), 2)))
        good = self._access(places.centre[asked], axes[:, None])[:, 0]
        found[asked[good]] = self._wanted
        if good.all() or not self._grids:
            return found
        for first, last in _runs(wanted):
            if np.isnan(found[first : last + 1, 0]).any():
                found[first : last + 1] = self._way(places.of(slice(first, last + 1)))
        return found

    def given_way(self, s, angles, bad, times):
        """Other angles for a curve that touches there, as it did some times before; None where nothing else is known."""

    def _free(self, places, grid):
        flat = grid.reshape(-1, 2)
        axes = self.lean.axes(places.normal[:, None], places.feed[:, None], flat[None])
        lean = np.cos(np.radians(flat)).prod(1) >= math.cos(math.radians(MOST)) - 1e-9
        free = np.zeros(axes.shape[:2], bool)
        free[:, lean] = self._access(places.centre, axes[:, lean], SPARE)
        return free.reshape(len(places.centre), *grid.shape[:2])

    def _way(self, places):
        """Chosen at some of the places, or where it would touch between them at all."""
        for every, even in EVERY:
            found = self._through(places, every, even)
            known = np.isfinite(found[:, 0])
            axes = self.lean.axes(places.normal[known], places.feed[known], found[known])
            if self._access(places.centre[known], axes[:, None]).all():
                break
        return found

    def _through(self, places, every, even):
        """The cheapest way through the angles that are free."""
        count = len(places.centre)
        some = np.unique(np.linspace(0, count - 1, max((count - 1) // every, 1) + 1).round().astype(int))
        found = self._cheapest(places.of(some), even)
        after = np.clip(np.searchsorted(some, np.arange(count)), 1, len(some) - 1) if count > 1 else np.zeros(1, int)
        before = np.maximum(after - 1, 0)
        share = ((np.arange(count) - some[before]) / np.maximum(some[after] - some[before], 1))[:, None]
        exact = np.where(share == 0, found[before], found[after])
        return np.where((share == 0) | (share == 1), exact, found[before] + share * (found[after] - found[before]))

    def _cheapest(self, places, even):
        """From place to place by one step of each angle at most."""
        for grid, (_, step) in zip(self._grids, STEPS):
            free = self._free(places, grid)
            if free.any((1, 2)).all():
                break
        cost = np.where(free, (((grid - self._wanted) / OFF_COST) ** 2).sum(2), np.inf)
        found = np.full((len(free), 2), np.nan)
        begin, total, froms = 0, None, []
        for number, here in enumerate(cost):
            new, back = (here, None) if total is None else _onward(total, here, step / TURN_COST)
            if np.isfinite(new).any():
                total = new
                froms.append(back)
                continue
            if total is not None:
                self._trace(found, grid, total, froms, begin, even)
            begin, total, froms = number + 1, None, []
        if total is not None:
            self._trace(found, grid, total, froms, begin, even)
        return found

    def _trace(self, found, grid, total, froms, begin, even):
        at = np.unravel_index(total.argmin(), total.shape)
        ways = [at]
        for back in froms[:0:-1]:
            at = tuple(back[at])
            ways.append(at)
        angles = np.array([grid[at] for at in ways[::-1]])
        for _ in range(even):
            angles = _evened(angles)
        found[begin : begin + len(angles)] = angles


def _onward(total, here, step_cost):
    """Costs of the next place, and from which angles each comes."""
    rows, columns = total.shape
    padded = np.pad(total, 1, constant_values=np.inf)
    shifts = [(i, j) for i in (0, -1, 1) for j in (0, -1, 1)]
    each = np.stack([padded[1 + i : 1 + i + rows, 1 + j : 1 + j + columns] + step_cost * (abs(i) + abs(j)) for i, j in shifts])
    best = each.argmin(0)
    back = np.stack(np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"), 2) + np.array(shifts)[best]
    return each.min(0) + here, back


def _evened(angles):
    half = WINDOW // 2
    padded = np.pad(angles, ((half, half), (0, 0)), mode="edge")
    return np.stack([padded[k : k + len(angles)] for k in range(WINDOW)]).mean(0)


def _grid(lean, lead_step, tilt_step):
    leads = np.array([lean.lead]) if lead_step is None else _around(lean.lead, lead_step)
    return np.stack(np.meshgrid(leads, _around(lean.tilt, tilt_step), indexing="ij"), 2)


def _around(angle, step):
    """Angles up to the most that are whole steps from it, itself among them."""
    low, high = math.ceil((-MOST - angle) / step - 1e-9), math.floor((MOST - angle) / step + 1e-9)
    return angle + step * np.arange(min(low, 0), max(high, 0) + 1)


def _runs(flags):
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return list(zip(edges[::2], edges[1::2] - 1))
