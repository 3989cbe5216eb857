"""Path jobs, read as they are."""

from rmac_freecad.jobs.job import read_job
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.jobs.table import EMPTY, JobTool, completed, lacking, tools_of

__all__ = ["EMPTY", "JobRefused", "JobTool", "completed", "lacking", "read_job", "tools_of"]
