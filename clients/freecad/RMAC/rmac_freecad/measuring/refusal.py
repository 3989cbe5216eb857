"""What cannot be measured, and what the machine refused while it measured."""


class MeasuringRefused(Exception):
    """It says what to do. `place` is the one at which the machine refused; None where none was begun."""

    def __init__(self, why, place=None):
        super().__init__(why)
        self.place = place
