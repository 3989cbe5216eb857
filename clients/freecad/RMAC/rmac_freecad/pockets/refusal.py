"""What cannot be cleared, with the place."""

from rmac_freecad.profiles.refusal import ProfileRefused


class PocketRefused(ProfileRefused):
    """`place` and `edge` as there."""
