"""What cannot be measured, and what the machine refused while it measured."""


class MeasuringRefused(Exception):
    """It says what to do."""
