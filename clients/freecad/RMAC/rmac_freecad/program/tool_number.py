"""What a tool may be called."""

import numbers


def is_tool_number(value):
    return isinstance(value, numbers.Integral) and not isinstance(value, bool) and value >= 1
