"""Machines searched, compared and loaded: the dissertation's figures 6.3 to 6.5, and 4.4."""
