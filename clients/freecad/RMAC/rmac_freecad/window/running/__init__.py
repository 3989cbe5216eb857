"""A job simulated and machined."""
