"""From what was simulated and what the axes did to the figures; the truth of each is computed here, by formulas of the part, the tool and the chain."""

import dataclasses
import json
import pathlib

import clamping
import clash
import dome
import numpy as np
import stl
import sweeps
import swept

BOUNDS = json.loads((pathlib.Path(__file__).parent / "bounds.json").read_text(encoding="utf-8"))
BODIES = ["clamp stud", f"tool {clamping.TOOL}, holder"]
PLACES, ON_FACES, SEED = 10000, 2000, 7  # that are looked at of the predicted part's surface
ON_A_FACE = 1e-3  # of the block as it was


@dataclasses.dataclass
class Figure:
    name: str
    value: float
    unit: str
    least: float = -np.inf
    most: float = np.inf
    key: str = ""  # in the JSON line

    def ok(self):
        return bool(self.least <= self.value <= self.most)

    def bound(self):
        if self.least == -np.inf:
            return f"{self.most:g}" if self.most < np.inf else ""
        return f"{self.least:g} to {self.most:g}" if self.most < np.inf else f"from {self.least:g}"


def of_program(moves, joints):
    return joints[moves >= sweeps.DOWN]


def in_motion_s(joints, period_s=0.001):
    """From the first to the last change."""
    changes = np.flatnonzero(np.abs(np.diff(joints, axis=0)).max(axis=1) > 0)
    return period_s * (changes[-1] - changes[0] + 1)


def places_of(corners):
    """So many places of a surface: those that were cut, and those on a face of the block as it was."""
    face = swept.out_of_stock(corners) > -ON_A_FACE
    draw = np.random.default_rng(SEED)

    def some(points, count):
        return points[draw.choice(len(points), min(len(points), count), replace=False)]

    return some(corners[~face], PLACES), some(corners[face], ON_FACES)


def off_um(cut, faces, joints):
    """How far a part that joints cut is from another one's surface: above it at places that were cut, and how deep it was cut at places of the block's own faces."""
    motion = swept.moving(swept.motion(joints))
    return 1000 * swept.left_over(cut, motion), 1000 * np.minimum(swept.left_over(faces, motion), 0)


def above_design(x, y, motion):
    """How high the surface that is left is above the part's top, along z and along its normal, mm."""
    points, normals = dome.surface(x, y)
    above = np.zeros(len(points))
    for _ in range(5):
        above += swept.from_ball(points + above[:, None] * [0, 0, 1], motion)
    return above, above * normals[:, 2]


def truth_of(motion):
    """What is left of the block, along lines of places across the sweeps: the most above the part, the most cut into it (mm), and the volume removed (mm³)."""
    along, across = 2.0, 0.1  # between places; the crests of ridges are among them
    half, wide = dome.LENGTH / 2, dome.WIDTH / 2
    x, y = np.meshgrid(np.arange(-half + along / 2, half, along), np.linspace(-wide, wide, round(2 * wide / across) + 1))
    above, left = above_design(x.ravel(), y.ravel(), motion)
    removed = np.trapz(dome.STOCK_HEIGHT - dome.height(x, y) - above.reshape(x.shape), dx=across, axis=0).sum() * along
    return left.max(), max(-left.min(), 0.0), removed


def of_first(first, held):
    """The collision, as it was found and before which the appliance held."""
    found = first.finding()
    near = np.abs(first.times - found["t_s"]) < 0.3
    inside = first.times[near][clash.gaps(first.joints[near]) < 0]
    met_s = inside[0] if len(inside) else np.inf
    return [
        Figure("first program: holder in the clamp's stud, deepest", found["depth_mm"], "mm", key="collision_mm"),
        Figure("  its begin off the one by formula", 1000 * abs(met_s - found["t_s"]), "ms", most=BOUNDS["first_contact_off_ms"]),
        Figure("  between holder and stud where the appliance held", float(clash.gaps(np.array([held.joints]))[0]), "mm",
               BOUNDS["held_nearest_mm"], BOUNDS["held_farthest_mm"], key="held_apart_mm"),
    ]  # fmt: skip


def of_second(second, record):
    """The prediction, and the part that the axes cut where they truly were."""
    told = second.told
    planned = of_program(second.moves, second.joints)
    motion = swept.moving(swept.motion(planned))
    rest, gouge, removed = truth_of(motion)
    deviation, forces = told["material"]["deviation"], told["forces"]
    place = np.array(deviation["rest_place_mm"])
    rest_there = above_design(place[:1], place[1:2], motion)[1][0]
    truth, setpoints = (of_program(record.move, joints) for joints in (record.truth, record.q))
    cut, faces = places_of(stl.corners(second.stock))
    predicted, predicted_faces = off_um(cut, faces, planned)
    machined, machined_faces = off_um(cut, faces, truth)
    figures = [
        Figure("second program: collisions", len(told["collisions"]), "", most=0, key="collisions"),
        Figure("  not checked, or not told", len(told["collisions_not_checked"]) + len(forces["not_told"]), "", most=0),
        Figure("  force, at most", forces["peak_force_n"], "N"),
        Figure("  power, at most", forces["peak_power_w"], "W"),
        Figure("  more than the spindle has", len(forces["overloads"]), "times", most=0),
        Figure("  cycle time, as predicted", told["cycle_time_s"], "s", key="cycle_time_s"),
        Figure("  time in motion, off the appliance's", 1000 * abs(in_motion_s(planned) - in_motion_s(setpoints)), "ms", most=BOUNDS["cycle_time_off_ms"]),
        Figure("predicted part: left above the design, most", 1000 * deviation["rest_mm"], "um", key="rest_um"),
        Figure("  off what is left there by formula", 1000 * abs(deviation["rest_mm"] - rest_there), "um", most=BOUNDS["rest_off_um"]),
        Figure("  the most anywhere by formula, crests between rays too", 1000 * rest, "um"),
        Figure("  cut into the design, most", 1000 * deviation["gouge_mm"], "um", most=BOUNDS["gouge_um"]),
        Figure("  the same by formula", 1000 * gouge, "um", most=BOUNDS["gouge_um"]),
        Figure("  volume removed, off the one by formula", 100 * abs(told["material"]["removed_mm3"] / removed - 1), "%", most=BOUNDS["removed_off_percent"]),
        Figure("  surface off what the planned axes cut, rms", rms(predicted), "um", most=BOUNDS["predicted_off_rms_um"], key="predicted_off_rms_um"),
        Figure("  the same, largest", largest(predicted, predicted_faces), "um", most=BOUNDS["predicted_off_um"]),
        Figure("machined part by formula: off the predicted one, rms", rms(machined), "um", most=BOUNDS["machined_off_rms_um"], key="machined_off_rms_um"),
        Figure("  the same, largest", largest(machined, machined_faces), "um", most=BOUNDS["machined_off_um"], key="machined_off_um"),
    ]
    return figures, cut, machined


def of_replay(replayed, second, record, resolution):
    """The part that `rmac simulate` cuts from the true motion: held to the formula, to the design, and ray by ray to the predicted one."""
    corners, deviation = stl.corners(replayed.stock), replayed.told["material"]["deviation"]
    by_formula = off_um(*places_of(corners), of_program(record.move, record.truth))
    rays = between_rays_um(stl.corners(second.stock), corners, resolution)
    return [
        Figure("machined part by rmac simulate: left above the design", 1000 * deviation["rest_mm"], "um"),
        Figure("  cut into the design, most", 1000 * deviation["gouge_mm"], "um", most=BOUNDS["machined_off_um"]),
        Figure("  off the one by formula, rms", rms(by_formula[0]), "um", most=BOUNDS["predicted_off_rms_um"]),
        Figure("  the same, largest", largest(*by_formula), "um", most=BOUNDS["replayed_off_um"]),
        Figure("  off the predicted one, ray by ray, rms", rms(rays), "um", most=BOUNDS["machined_off_rms_um"], key="machined_off_by_rays_rms_um"),
        Figure("  rays along z that were compared", len(rays), "", least=0.9 * dome.LENGTH * dome.WIDTH / resolution**2),
    ]


def on_rays(corners, resolution):
    """Numbers of the rays along z, and the heights where they leave the material that was cut."""
    number = (corners[:, :2] + [dome.LENGTH / 2, dome.WIDTH / 2]) / resolution - 0.5
    whole = np.rint(number)
    these = (np.abs(number - whole).max(axis=1) < 1e-3) & (swept.out_of_stock(corners) < -ON_A_FACE)
    keys, first = np.unique(whole[these] @ [1, round(dome.LENGTH / resolution)], return_index=True)
    return keys, corners[these][first]


def between_rays_um(predicted, machined, resolution):
    """Along the part's normal, how far the machined surface is above the predicted one on the rays along z that meet both."""
    (keys, places), (others, machined_places) = on_rays(predicted, resolution), on_rays(machined, resolution)
    _, here, there = np.intersect1d(keys, others, return_indices=True)
    higher = machined_places[there][:, 2] - places[here][:, 2]
    return 1000 * higher * dome.surface(*places[here][:, :2].T)[1][:, 2]


def rms(off):
    return float(np.sqrt((off**2).mean()))


def largest(*offs):
    return float(max(np.abs(off).max() for off in offs))


def problems(first, held, second):
    """What is wrong and is no figure."""
    found = first.finding() if first.told["collisions"] else {"bodies": [], "move_id": 0, "certain": False}
    if found["bodies"] != BODIES or not found["certain"]:
        yield f"the first program's finding is {found['bodies']}, and {BODIES} was planted"
    if held.move_id != found["move_id"] or held.state != "Holding":
        yield f"the appliance is {held.state} in move {held.move_id}; the holder meets the stud in move {found['move_id']}"
    if second.warning:
        yield f"the second program: {second.warning}"
    if 0 < found["move_id"] < sweeps.FIRST_SWEEP:
        yield "the holder meets the stud before it cuts"
