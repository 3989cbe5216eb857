"""Holes drilled: their list, and the dialog."""
