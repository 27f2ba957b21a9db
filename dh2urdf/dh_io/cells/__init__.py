"""From the text of a cell to its value: units, expressions, keys."""
