"""The translator: kernels, which are Python, are written as C99 and compiled into the package.

`entries` finds what Python calls, `source` reads a function, `types` and `inference` find what
everything in it is, `scopes`, `expressions` and `statements` write it, `c_text` and `c_file` put
the file together, `extension` adds the doors for Python, `build` compiles. The standard library
and NumPy suffice: it runs before the package is installed.
"""
