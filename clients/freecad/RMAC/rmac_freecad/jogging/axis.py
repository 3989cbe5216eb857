"""What can be jogged: X, Y and Z of the part frame, and joints that turn."""

from dataclasses import dataclass

import rmac
from rmac.generated.enums import JointType

calls = rmac.calls.RMAC_CAM


@dataclass(frozen=True)
class Axis:
    name: str
    direction: tuple | None  # of the tool tip in the part frame; None: a joint of its own
    joint: int | None
    highest_speed: float  # mm/s or deg/s

    @property
    def turns(self):
        return self.joint is not None

    def by(self, distance):
        """Calls that jog by a distance, mm or degrees."""
        if self.turns:
            return calls.JogJoint(self.joint, distance, None)
        return calls.JogPath(self.direction, distance, None, None)

    def at(self, velocity):
        """For 200 ms of the machine's time; 0 ends it. mm/s or deg/s."""
        velocity = max(-self.highest_speed, min(self.highest_speed, velocity))
        if self.turns:
            return calls.JogJoint(self.joint, None, velocity)
        return calls.JogPath(self.direction, None, velocity, None)

    def place(self, state):
        """Where it stands, of the topic `state`."""
        return state["joints"][self.joint] if self.turns else state["pose"]["XYZ".index(self.name)]


def axes_of(machine):
    """Of a `rmac.LoadedMachine`."""
    axes = [
        Axis(name, tuple(float(name == other) for other in "XYZ"), None, machine.max_feed_mm_min / 60) for name in "XYZ"
    ]
    for joint in machine.joints:
        if joint.type == JointType.DMAC_ROT_JNT:
            axes.append(Axis(f"joint {joint.number + 1}", None, joint.number, joint.max_speed))
    return axes
