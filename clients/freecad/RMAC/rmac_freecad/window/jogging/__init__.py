"""The machine moved by hand: the dissertation's figure 6.6."""
