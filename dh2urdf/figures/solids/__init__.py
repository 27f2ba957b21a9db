"""Solids of a figure in orthographic projection: outlines, tones, and what hides what."""
