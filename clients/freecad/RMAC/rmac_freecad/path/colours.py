"""What a line's colour says: red, green and blue from 0 to 1."""

LATER = (0.55, 0.55, 0.6)
DONE = (0.1, 0.65, 0.2)
# By the last word of a limit, as `rmac simulate` names them: "feed", "path acceleration", "X velocity", "X jerk", …
LIMITS = {"feed": (0.1, 0.45, 0.85), "velocity": (0.95, 0.65, 0.0), "acceleration": (0.85, 0.2, 0.1), "jerk": (0.7, 0.1, 0.75)}


def colour_of_limit(limit):
    """Where none ruled, that of what is not cut yet."""
    return LIMITS.get(limit.rsplit(" ", 1)[-1], LATER)
