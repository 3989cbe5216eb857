"""Edges and sketches cut along."""
