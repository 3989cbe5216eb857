"""From pass to pass: each step as wide as the scallop allows, and a pass between where two left more."""

import dataclasses
import math
from dataclasses import dataclass

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces.rows import Row

STEADY = 0.98  # a step is taken when its ridge is so near to what is wanted
CLOSE = 0.02  # or when one that is so little longer leaves too much
MOST_TRIES = 14
MOST_PASSES = 5000
WIDEST = 1.6  # radii from pass to pass
CLOSEST = 1 / 64  # of a step on a plane: there it is told instead


@dataclass
class Pass:
    """Stretches, each of curves (knots, poles) that follow each other; its place across, in mm."""

    w_mm: float
    stretches: list
    trace: object = None  # as the witnesses have it


@dataclass
class _Laid:
    row: Row
    stretches: list
    trace: Row


class Passes:
    """`rows` tell of a pass what it touches, `stretches` lay its curves; `ridge_mm` may stand between two."""

    def __init__(self, rows, stretches, radius_mm, ridge_mm, closest=CLOSEST, widest_mm=None):
        self._closest = closest
        self._rows, self._family, self._stretches, self._ridge_mm = rows, rows.family, stretches, ridge_mm
        self._widest = WIDEST * radius_mm if widest_mm is None else widest_mm
        self._plain = self._step = min(math.sqrt(8 * radius_mm * ridge_mm), self._widest)
        self.high = []

    def rows(self):
        """Those that cut something, each a step from the one before."""
        return [row for row in self._steps() if row.core.any()]

    def laid(self, witnesses, limit_mm):
        """Held against the witnesses; `high` tells where they find more than the limit nevertheless."""
        ahead = [self._lay(row, witnesses) for row in reversed(self.rows())]
        found = []
        while ahead:
            one = ahead.pop()
            while ahead:
                up, place = witnesses.highest(one.trace, ahead[-1].trace, limit_mm)
                between = self._between(one.row, ahead[-1].row) if place is not None else None
                if between is None:
                    break
                ahead.append(self._lay(between, witnesses))
            if ahead and place is not None:
                what = f"up to {up:.3g} mm are left between passes" if math.isfinite(up) else "is a place that no pass gets to"
                self.high.append(f"at {', '.join(f'{x:.3f}' for x in place)} {what}")
            found.append(Pass(one.row.w * self._family.w_mm, one.stretches, one.trace))
        return found

    def _lay(self, row, witnesses):
        stretches = self._stretches.of(row)
        return _Laid(row, stretches, witnesses.trace(row, stretches))

    def _between(self, before, after):
        """The pass in the middle; None where it cuts nothing, or both are closer together than makes sense."""
        gap = (after.w - before.w) * self._family.w_mm
        if gap < self._closest * self._plain:
            return None
        row = self._rows.at((before.w + after.w) / 2)
        if not row.core.any():
            return None
        self._rows.reach(row, before, gap)
        self._rows.reach(row, after, gap)
        return row

    def _steps(self):
        low, high = self._family.w_range
        if high < low:
            low = high = (low + high) / 2
        found = [self._rows.at(low)]
        while found[-1].w < high:
            if len(found) > MOST_PASSES:
                raise JobRefused(f"more than {MOST_PASSES} passes would be needed; give a larger scallop or mill, or a smaller steepest_deg")
            row = found[-1]
            after = self._next(row, high)
            if row.core.any() == after.core.any():
                found.append(after)
                continue
            # Where passes begin or end to find something to cut, one is laid at that border, and steps are taken from it or up to it.
            border = self._border(row, after)
            if not row.core.any():
                found.append(border or after)
                continue
            while border is not None and found[-1].w < border.w:
                found.append(self._next(found[-1], border.w))
            found.append(after)
        return found

    def _next(self, row, high):
        """The farthest next pass that leaves no higher ridge than is wanted."""
        unit = self._family.w_mm
        good, low, bad = None, 0.0, math.inf
        left = most = 0.0  # roots of what these leave: about as wide as the steps
        for _ in range(MOST_TRIES):
            w = min(row.w + self._step / unit, high)
            if high - w < 0.02 * self._step / unit:
                w = high
            after, found = self._tried(row, w)
            step = (w - row.w) * unit
            if found is None or found <= self._ridge_mm:
                good, low, left = after, step, math.sqrt(found or 0)
                if found is None or w >= high or step >= self._widest * 0.999 or found >= STEADY * self._ridge_mm:
                    break
            else:
                bad, most = step, math.sqrt(found)
            if bad - low < CLOSE * bad:
                break
            wanted = math.sqrt(0.99 * self._ridge_mm)
            wished = step * min(max(wanted / math.sqrt(max(found, 1e-9)), 0.3), 2.0)
            if math.isfinite(bad):
                least = 0.25 if good else 0.1
                wished = low + (bad - low) * min(max((wanted - left) / (most - left), least), 1 - least)
            self._step = min(wished, self._widest)
        if good is None:
            raise JobRefused("no step from pass to pass leaves so low a ridge; give a larger scallop, another direction or a smaller steepest_deg")
        self._rows.reach(row, good, low)
        self._rows.reach(good, row, low)
        return good

    def _tried(self, row, w):
        """The pass there, and the ridge between both."""
        before = dataclasses.replace(row, used=row.used.copy())
        after, middle = self._rows.at_and_between(w, (row.w + w) / 2)
        step = (w - row.w) * self._family.w_mm
        self._rows.reach(before, after, step)
        self._rows.reach(after, before, step)
        found = self._rows.ridge(before, middle, after)
        after.used = after.core.copy()
        return after, found

    def _border(self, a, b):
        """Between a pass that cuts and one that does not."""
        cuts, idle = (a, b) if a.core.any() else (b, a)
        good, w = None, cuts.w
        off = idle.w
        while abs(off - w) * self._family.w_mm > 1e-3:
            row = self._rows.at((w + off) / 2)
            if row.core.any():
                good, w = row, row.w
            else:
                off = row.w
        if good is not None:
            self._rows.reach(good, cuts, self._step)
        return good
