"""What it takes to draw the machine as it moves: its bodies, once, and where its links stand, again and again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rmac.geometry.frame import Frame, read_frame

RATE_HZ = 60.0


@dataclass(frozen=True, slots=True)
class Body:
    """A solid on a link. `shape` is as in device.json: `{"Box": {"Size": [x, y, z]}}`, `Cylinder`, `Cone`, `Sphere`, or
    `{"Mesh": {"File": …}}`, whose surface `cam.GetMesh(name)` gives. `pose`: with all joints at 0."""

    name: str
    link: str
    shape: Mapping[str, Any]
    pose: Frame
    colour: str  # "#rrggbb", or empty


@dataclass(frozen=True, slots=True)
class MachineGeometry:
    """The machine that is loaded. `missing` says what is not known of it, or is empty; without `links` nothing is told of
    where they stand."""

    number: int
    machine: str | None
    missing: str
    joints: tuple[str, ...]
    links: tuple[str, ...]
    interface: Frame | None  # where the tool interface is while all joints stand at 0; it moves with the link `spindle`
    bodies: tuple[Body, ...]


@dataclass(frozen=True, slots=True)
class Sample:
    """One moment. `links`: by which frame each link, by its name, is moved from where it stands with all joints at 0; a body
    is at `links[body.link].times(body.pose)`. `pose`: x y z i j k of the tool in the part frame; all is measured."""

    t_s: float
    cycle: int
    moving: bool
    move_id: int
    pose: tuple[float, ...]
    joints: tuple[float, ...]
    links: Mapping[str, Frame]


@dataclass(frozen=True, slots=True)
class Animation:
    """Samples of one machine with one tool: where `geometry` is another number than that of the `MachineGeometry`, another machine was
    loaded, and its geometry is to be asked for. Without samples `missing` says why there are none."""

    geometry: int
    machine: str | None
    missing: str
    virtual: bool
    tool: int | None  # 0: none, None: not known
    part_frame: Frame  # on the table
    tool_frame: Frame  # the tip, on the tool interface
    samples: tuple[Sample, ...]

    def tip(self, sample: Sample, geometry: MachineGeometry) -> Frame:
        """The tool tip, in the frame of the base as all links are."""
        interface = geometry.interface or Frame()
        return sample.links["spindle"].times(interface).times(self.tool_frame)

    def part(self, sample: Sample) -> Frame:
        """The part's frame, likewise."""
        return sample.links["table"].times(self.part_frame)


def read_geometry(told: Mapping[str, Any]) -> MachineGeometry:
    bodies = (
        Body(body["Name"], body["Link"], body["Shape"], read_frame(body["Pose"]), body.get("Colour", ""))
        for body in told["bodies"]
    )
    interface = told["interface"]
    return MachineGeometry(
        told["geometry"], told["machine"], told["missing"], tuple(told["joints"]), tuple(told["links"]),
        None if interface is None else read_frame(interface), tuple(bodies),
    )  # fmt: skip


def read_animation(told: Mapping[str, Any]) -> Animation:
    return Animation(
        told["geometry"], told["machine"], told["missing"], told["virtual"], told["tool"], read_frame(told["part_frame"]),
        read_frame(told["tool_frame"]), tuple(_read_sample(sample) for sample in told["samples"]),
    )  # fmt: skip


def _read_sample(told: Mapping[str, Any]) -> Sample:
    links = {name: read_frame(frame) for name, frame in told["links"].items()}
    return Sample(
        told["t_s"], told["cycle"], told["moving"], told["move_id"], tuple(told["pose"]), tuple(told["joints"]), links
    )
