"""The pieces of work that are measured, one module each; every ``run`` adds rows to the results."""
