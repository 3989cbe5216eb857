"""Path jobs, read as they are."""

from rmac_freecad.jobs.job import read_job
from rmac_freecad.jobs.refusal import JobRefused

__all__ = ["JobRefused", "read_job"]
