"""A part measured by touch, and held against its model."""
