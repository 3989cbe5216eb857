"""What a job says that is not understood, or that no machine could do."""


class JobRefused(Exception):
    """`place` tells where in the job, or is None where that is the job as a whole."""

    def __init__(self, why, place=None):
        super().__init__(f"{place}: {why}" if place else why)
        self.place = place
        self.why = why
