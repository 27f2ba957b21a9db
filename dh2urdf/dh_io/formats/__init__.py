"""Formats of table files, each read into one document with the place of every cell."""
