#!/usr/bin/python3
"""Proposes gains, and filters, for a joint.

The record of its swings tells mass, friction, load and delay of a rigid joint; with one of swept sines, the joint's
frequency response is measured, and gains and filters are for what was measured. Draws Bode and step plots of the loop
before and after into a picture, and prints what was found as JSON."""

import argparse
import json
import sys

import matplotlib

matplotlib.use("Agg")
import creep
import frequency_response
import loop_design as design
import matplotlib.pyplot as plt
import numpy as np
import servo_model as model

# Further off than this (rms of the logarithm of measured over model), the model is not the joint's.
WORST_MISFIT = 0.4
# Of the mass that swings move, what sines may move less or more: joints that both see whole are within 1.05, and a loop for four
# fifths of a joint, which a motor has within its play, may not hold all of it.
MOST_OF_MASS = 1.2
SHARE_ON_ONE_FLANK = 0.25  # of friction: an effort that does not throw a sliding joint off its flank
# Phase margins in degrees: below the first a loop rings from one sine into the next; the second is of one that does not.
LEAST_TO_SWEEP = 5.0
SETTLES = 45.0
SLOWER = 0.8
# Of its slowest resonance: smoothed over so long, a joint that rings shows how its whole mass goes.
PERIODS_SMOOTHED = 3


def feedback_gains(joint):
    """Kp, Ki, Kd of the law that is in force; None where it has none."""
    gains = joint["gains"]
    if len(gains) in (3, 7):
        return tuple(gains[:3])
    if "Fuzzy" in joint["law"]:  # what it is at its centre
        error_range, rate_range, effort_range, ki = gains
        return 2 * effort_range / error_range, ki, 2 * effort_range / rate_range
    return None


def gains_to_sweep(loop, plant, period):
    """Those in force, which hold the joint; where they hardly do, because its mass is not what they were made for, ones that cross 1
    earlier and let it settle between sines."""
    rigid = frequency_response.Model(period, plant.mass, plant.delay_s)
    found = design.margins_of(loop, rigid)
    if found.stable and found.phase_margin_deg >= LEAST_TO_SWEEP:
        return list(loop.gains)
    settling = design.gains_for(rigid, design.Filters(), SLOWER * found.bandwidth_hz, SETTLES) if found.bandwidth_hz > 0 else None
    return list(settling or loop.gains)


def load_known(joint):
    """The load that the law in force counts on."""
    return joint["gains"][6] if len(joint["gains"]) == 7 else joint["parameters"].get("load", [0])[0]


def loop_in_force(joint):
    """What closes around the joint, None where its law has no feedback."""
    gains = feedback_gains(joint)
    if gains is None:
        return None
    notches = [design.Notch(**notch) for notch in joint["resonances"]]
    filtered = joint["parameters"].get("derivative_filter_s", [0])[0]
    return design.Loop(gains, design.Filters(notches, joint["low_pass"]), filtered)


def describe(loop, found):
    """Gains and filters, and what the loop is with them."""
    return {"gains": list(loop.gains), "filters": filters_of(loop), "stable": found.stable,
            "bandwidth_hz": found.bandwidth_hz, "phase_margin_deg": found.phase_margin_deg,
            "gain_margin_db": found.gain_margin_db if np.isfinite(found.gain_margin_db) else None,
            "sensitivity_peak": found.sensitivity_peak if np.isfinite(found.sensitivity_peak) else None}


def filters_of(loop):
    """As device.json has them."""
    return {"Resonances": [{"Frequency": notch.frequency, "Damping": notch.damping, "Width": notch.width}
                           for notch in loop.filters.notches], "LowPass": loop.filters.low_pass}


def draw(title, loops, joint, response, period, path):
    """Open loop and step of each of `loops` (label, loop, margins), and beside them what was measured."""
    figure, (size, phase, step) = plt.subplots(3, 1, figsize=(9, 11), constrained_layout=True)
    frequency = np.unique(np.concatenate([design.grid(joint), np.geomspace(1, 0.499 / period, 1000)]))
    for label, loop, found in loops:
        values = design.open_loop(loop, joint, frequency)
        angle = np.degrees(np.unwrap(np.angle(values)))
        angle -= 360 * np.ceil(angle[0] / 360)
        line, = size.loglog(frequency, np.abs(values),
                            label=f"{label}: {found.bandwidth_hz:.1f} Hz" if found.stable else f"{label}: unstable")
        phase.semilogx(frequency, angle, color=line.get_color(),
                       label=f"{label}: margin {found.phase_margin_deg:.0f}°" if found.stable else label)
        if response is not None:
            law = design.law_response(loop, response.frequency, period)
            law = law * loop.filters.response(response.frequency, period)
            seen = law * response.value
            near = np.interp(response.frequency, frequency, angle)
            size.loglog(response.frequency, np.abs(seen), ".", markersize=3, color=line.get_color())
            phase.semilogx(response.frequency, near + np.degrees(np.angle(seen / np.exp(1j * np.radians(near)))), ".",
                           markersize=3, color=line.get_color())
        if found.stable:
            time, position = design.step_response(loop, joint)
            step.plot(1e3 * time, position, label=label, color=line.get_color())
    size.axhline(1, color="grey", linewidth=0.8)
    size.set_ylabel("open loop" + (" (points: measured)" if response is not None else ""))
    phase.axhline(-180, color="grey", linewidth=0.8)
    phase.set_ylim(-720, 0)
    phase.set_ylabel("phase, degrees")
    phase.set_xlabel("Hz")
    step.axhline(1, color="grey", linewidth=0.8)
    step.set_ylim(0, 2)
    step.set_ylabel("step, without friction and bounds")
    step.set_xlabel("ms")
    for axes in (size, phase, step):
        axes.grid(alpha=0.3, which="both")
        axes.legend(fontsize=8)
    figure.suptitle(title, fontsize=9)
    figure.savefig(path, dpi=120)


def read_words(words):
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("record", help="flight record of the joint's swings")
    parser.add_argument("joint", type=int, help="from 0")
    parser.add_argument("begin", type=float, help="t_s after which the swings are")
    parser.add_argument("--bandwidth", type=float, default=0, help="Hz; 0: the largest that keeps its margins")
    parser.add_argument("--margin", type=float, required=True, help="degrees")
    parser.add_argument("--picture", required=True)
    parser.add_argument("--creep", nargs=2, help="flight records of strokes that creep: some turns, and to and fro")
    parser.add_argument("--creep-begin", nargs=2, type=float, help="t_s after which each is")
    parser.add_argument("--sweep", nargs="+", help="flight records of swept sines")
    parser.add_argument("--sweep-begin", nargs="+", type=float, help="t_s after which each is")
    parser.add_argument("--sweep-period", type=float, help="s")
    parser.add_argument("--sweep-effort", type=float, help="N or N·m")
    parser.add_argument("--sweeps", type=int, help="of each steady stretch")
    parser.add_argument("--from-hz", type=float)
    parser.add_argument("--to-hz", type=float)
    return parser.parse_args(words)


def measured_joint(given, plant):
    """Model and measured response; of a rigid joint, and None, where there was no sweep."""
    head, columns = model.read_record(given.record, given.begin)
    period = model.period_of(columns)
    if given.sweep is None:
        return frequency_response.Model(period, plant.mass, plant.delay_s), None
    records = swept(given)
    response = frequency_response.measure(records, given.joint + 1, given.sweep_period, given.sweeps, (given.from_hz, given.to_hz))
    joint = frequency_response.fit(response, period)
    if joint.misfit > WORST_MISFIT:
        raise frequency_response.Unheard(
            f"what was measured is no mass with up to {frequency_response.MOST_MODES} resonances (off by "
            f"{joint.misfit:.2f} in the logarithm, {WORST_MISFIT} at most); nothing is proposed. Sines of more effort are heard "
            "better: --sweep-effort")
    return joint, response


def as_it_answers(columns, joint, bent):
    """What swings show, where the joint's response is known: with the delay of that, which tells it apart from friction and
    cogging, and behind smoothing that leaves nothing of resonances."""
    slowest = min((hz for hz, _ in bent.resonances()), default=np.inf)
    window = max(model.WINDOW_S, PERIODS_SMOOTHED / slowest)
    return model.identify(columns["t_s"], columns[f"a{joint + 1}"], columns[f"effort{joint + 1}"],
                          delay=bent.delay_s + bent.lag_s, window_s=window, wanted=columns[f"q{joint + 1}"])


def check_mass(plant, bent, unit, sweep):
    """That the sines of this `sweep` moved all that swings move. Within play they move the motor alone, and a loop for that swings as soon
    as the load goes along; sines that friction outweighs leave a joint that slides on one flank of its play."""
    share = bent.mass / plant.mass
    if 1 / MOST_OF_MASS <= share <= MOST_OF_MASS:
        return
    of = "N·m·s²/deg" if unit == "deg" else "N·s²/mm"
    seen = f"sines move {bent.mass:.3g} {of}, and swings {plant.mass:.3g}"
    if share > 1:
        raise frequency_response.Unheard(f"{seen}: one of them does not show the joint's mass; nothing is proposed. Swing it by more --travel")
    soft = SHARE_ON_ONE_FLANK * plant.friction
    flank = f"; sines that leave a sliding joint on one flank say whether it is play: --sweep-effort {soft:.2g}"
    raise frequency_response.Unheard(
        f"{seen}: the sines do not show the joint's whole mass, as where they throw a motor to and fro within its play, or where it "
        f"swings near {sweep.from_hz:.0f} Hz or below; nothing is proposed" + (flank if 0 < soft < sweep.sweep_effort else ""))


def swept(given):
    """Columns of each record of sines."""
    return [model.read_record(file, begin)[1] for file, begin in zip(given.sweep, given.sweep_begin)]


def motor_of(head, columns, joint):
    """The motor that moves the joint, and why that is not known."""
    try:
        return creep.motor_of(head, columns, joint), None
    except (model.Unidentifiable, KeyError) as problem:
        return None, f"--creep: {problem}"


def side_by_side(motor, head, columns, loop):
    """What holds several motors of a joint in step, as device.json has it: each moves its share of the joint, under its share of the gains
    as the joint does under all of them, and without an integral. None of one motor."""
    if motor is None or len(motor.actuators) == 1:
        return None
    count = len(motor.actuators)
    return {"motors": count, "apart": creep.apart(motor, head, columns),
            "Gantry": {"Stiffness": rounded(loop.gains[0] / count), "Damping": rounded(loop.gains[2] / count)}}


def rounded(value):
    """To five digits: what is written into device.json is read by people."""
    return float(f"{value:.5g}")


def as_device_json(cogging):
    """Of a flight record's head."""
    return {"Lead": cogging["lead"], "Harmonics": [{key.capitalize(): value for key, value in one.items()} for one in cogging["harmonics"]]}


def crept(given, head, plant, bent, lead):
    """What creeping has shown, for the law with feedforward and for the motor; None without it."""
    if given.creep is None:
        return None
    records = [model.read_record(file, begin)[1] for file, begin in zip(given.creep, given.creep_begin)]
    motor, found = creep.find(head, records, given.joint, plant, bent)
    friction = found.friction
    kept = {key: value for key, value in head["joints"][given.joint]["parameters"].items()
            if key in ("derivative_filter_s", "rest_band")}
    parameters = {"lead_s": lead, "presliding": friction.presliding, "breakaway": friction.breakaway,
                  "stribeck_speed": friction.stribeck_speed}
    harmonics = [{"Order": order, "Cosine": rounded(cosine), "Sine": rounded(sine)} for order, cosine, sine in found.harmonics]
    return {"friction": friction.sliding, "explained": found.explained,
            "parameters": {**kept, **{key: [rounded(value)] for key, value in parameters.items()}},
            "motor": None if creep.no_cogging(motor) else {
                "actuator": motor.actuators[0], "of": len(head["actuators"]), "rated_torque": motor.rated_torque,
                "cogging_in_force": as_device_json(head["actuators"][motor.actuators[0]]["cogging"]),
                "cogging": {"Lead": rounded(plant.delay_s), "Harmonics": harmonics},
                "hidden": [{"order": order, "hz": hz} for order, hz in found.hidden]},
            "no_cogging": creep.no_cogging(motor)}


def main():
    """Exit code 1 with one line that says why, when the record or the wish does not do."""
    given = read_words(sys.argv[1:])
    head, columns = model.read_record(given.record, given.begin)
    joint = head["joints"][given.joint]
    column = given.joint + 1
    try:
        plant = model.identify(columns["t_s"], columns[f"a{column}"], columns[f"effort{column}"], wanted=columns[f"q{column}"])
        bent, response = measured_joint(given, plant)
        if response is not None:
            plant = as_it_answers(columns, given.joint, bent)
            check_mass(plant, bent, joint["unit"], given)
        proposed = design.design(bent, given.margin, given.bandwidth)
        lead = plant.delay_s + proposed.filters.delay_s()
        creeping = crept(given, head, plant, bent, lead)
    except frequency_response.Unheard as problem:
        print(json.dumps({"unmeasured": str(problem)}))
        return 0
    except (model.Unidentifiable, frequency_response.Unmeasured, design.Undesignable) as problem:
        print(problem, file=sys.stderr)
        return 1
    before = loop_in_force(joint)
    loops = [(label, loop, design.margins_of(loop, bent))
             for label, loop in (("before", before), ("proposed", proposed)) if loop]
    modes = ", ".join(f"{hz:.0f} Hz ({damping:.3f})" for hz, damping in bent.resonances())
    draw(f"{head['mechanism']}, joint {joint['name']}: mass {1e3 * plant.mass:.3g}e-3, friction {plant.friction:.3g} + "
         f"{plant.viscous:.3g} v, load {plant.load:.3g}, delay {1e3 * plant.delay_s:.2f} ms"
         + (f", resonances {modes}" if modes else ""), loops, bent, response, bent.period, given.picture)
    told = {label: describe(loop, found) for label, loop, found in loops}
    friction = creeping["friction"] if creeping else plant.friction
    forward = [*proposed.gains, plant.viscous, plant.mass, friction, plant.load]
    motor, no_creep = motor_of(head, columns, given.joint)
    print(json.dumps({
        "joint": joint["name"], "unit": joint["unit"], "law": joint["law"], "plant": model.as_json(plant),
        "max_speed": joint["max_speed"], "max_effort": joint["max_effort"], "parameters": joint["parameters"],
        "gains": joint["gains"], "load_known": load_known(joint), "period_s": bent.period,
        "resonances": [{"frequency": hz, "damping": damping} for hz, damping in bent.resonances()],
        "misfit": bent.misfit if response is not None else None,
        "before": told.get("before"), "proposed": told["proposed"],
        "elsewhere": describe(proposed, design.judge(proposed, bent)),
        "sweep_gains": gains_to_sweep(before, plant, bent.period) if before else None,
        "filters_in_force": filters_of(before) if before else None,
        "pid_gains": list(proposed.gains), "feedforward_feedback_gains": forward,
        "lead_s": lead, "turn": abs(motor.turn) if motor else None, "no_creep": no_creep, "creep": creeping,
        "side_by_side": side_by_side(motor, head, columns, proposed),
        "apply": {3: list(proposed.gains), 7: forward}.get(len(joint["gains"]))}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
