"""The translator: kernels, which are Python, are written as C99 and compiled into the package.

`entries` finds what Python calls, the types of its arguments, and writes its doors; `source` reads
a function and decides where names are declared; `types` are those of C. One pass writes a function
for the types that it is called with, and refuses what is outside the subset: `values` (names and
known lengths), `expressions`, `calls`, `assignments` and `statements` stand on one another.
`definitions` has what functions share, `c_file` the whole. `build` compiles it, once for each level
of processor. What is C once and for all is in `support.h` and `doors.c`, which takes the best level
or that of ``DH2URDF_LEVEL``. The standard library and NumPy suffice: it runs before the package is
installed.

What the author of a kernel must know, for the interpreted function is the definition:

* Numbers are float, int or bool; an int has 32 bits in C (64 in an array), so that counts, indices
  and masks must stay below 2^31. A name has one type. ``/`` of ints is a float, ``//`` and ``%`` go
  towards minus infinity, and have one ``int``. ``int(x)`` cuts towards zero, for |x| < 2^31.
* What raises in Python must not arise, for C goes on: division by zero, the root of a negative
  number, an index or a slice beyond an array (refused where it is known), a shift by more than 31.
* ``np.floor``, ``np.ceil`` and ``np.rint`` are C's; ``math.floor`` gives an int, which has no
  negative zero, and is refused. No sine: each library rounds its own; `elementary` has one.
* ``and``, ``or`` and ``not`` give bools, whatever they join. ``min`` and ``max`` take values of
  one type and give the first of two that compare as equal or as nothing (NaN).
* All values of an assignment are read before a target is written, except that what a kernel called
  there writes into an array is seen by the values after it.
* ``range`` looks at its bounds once; its counter is not assigned to and ends with its loop.
* ``a[i] = b``, ``a[:] = x + b`` and ``a *= x`` go over the elements one by one, in their order.
* Arrays lie in C order. Shapes are numbers and lengths of arguments; a local array lives as long as
  its function and has no values before they are assigned. Different arguments do not overlap.
* A tuple of numbers is a struct; one with arrays is taken apart into arguments of their own. A
  kernel that does nothing but ``return np.empty(...), ...`` makes arrays for its caller.
* ``T.ndim == 1``, of dimensions or known lengths, is decided when the kernel is translated.
* ``side_by_side`` is a ``range`` whose turns do not depend on one another.
"""
