"""What is wanted of a machine, as the condition by which the appliance searches its database."""

from dataclasses import dataclass, fields

TYPES = ("Mill", "CMM", "Bench")
# Column of the database, and whether a machine must have at least as much, or at most.
COLUMNS = {
    "joints": ("NumberOfJoints", "="), "length_mm": ("Length", ">="), "width_mm": ("Width", ">="), "depth_mm": ("Depth", ">="),
    "spindle_hp": ("SpindleHorsePower", ">="), "spindle_rpm": ("SpindleMaxSpeed", ">="), "spindle_torque_nm": ("SpindleMaxTorque", ">="),
    "feed_mm_min": ("MaxFeedrate", ">="), "load_kg": ("MaxPalletLoad", ">="),
    "positioning_mm": ("PositioningTolerance", "<="), "repeatability_mm": ("RepeatabilityTolerance", "<="),
}  # fmt: skip


@dataclass
class Wanted:
    """0, or an empty text: whatever it is."""

    name: str = ""  # or a part of it
    type: str = ""
    joints: int = 0
    length_mm: float = 0
    width_mm: float = 0
    depth_mm: float = 0
    spindle_hp: float = 0
    spindle_rpm: float = 0
    spindle_torque_nm: float = 0
    feed_mm_min: float = 0
    load_kg: float = 0
    positioning_mm: float = 0
    repeatability_mm: float = 0

    def condition(self):
        """SQL, as `client.machines` takes it; empty where nothing is wanted."""
        parts = []
        if self.name:
            parts.append(f"Name LIKE {_quoted('%' + self.name + '%')}")
        if self.type:
            parts.append(f"Type = {_quoted(self.type)}")
        for field in fields(self)[2:]:
            column, relation = COLUMNS[field.name]
            value = getattr(self, field.name)
            if value:
                parts.append(f"{column} {relation} {value:.12g}")
        return " AND ".join(parts)


def _quoted(text):
    return "'" + text.replace("'", "''") + "'"
