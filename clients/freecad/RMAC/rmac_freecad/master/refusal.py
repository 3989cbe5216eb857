"""What measurements do not tell, or a model does not take."""


class MasterRefused(Exception):
    """It says what to do."""
