"""A part that somebody else drew: opened, and what there is to machine."""
