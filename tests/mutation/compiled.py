"""Compile the kernels of a package that stands elsewhere as soon as can be.

``python -m tests.mutation.compiled``, where ``dh2urdf`` is the changed package, ends with 3 where
that cannot be translated. The code is not optimized, that for any processor in the place of others.
"""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np


def compiled() -> None:
    """Write the extension into the package."""
    from dh2urdf import engine
    from dh2urdf.translate.build import FLAGS, PLACE, compiler, texts

    doors = Path(engine.PACKAGE, "translate", "doors.c")
    include = [f"-I{sysconfig.get_paths()['include']}", f"-I{np.get_include()}", "-I."]
    flags = [*(flag for flag in FLAGS if not flag.startswith("-O")), "-O0", "-w"]
    same = ["-Wl,--defsym=entries_v3=entries_any", "-Wl,--defsym=entries_v4=entries_any"]
    with TemporaryDirectory() as folder:
        for name, text in texts().items():
            Path(folder, name).write_text(text)
        sources = f'-DSOURCES="{engine.fingerprint()}"'
        files = ["-DTABLE=entries_any", sources, "kernels.c", str(doors)]
        command = [*compiler(), *flags, *include, *files, "-shared", *same, "-o", str(PLACE), "-lm"]
        subprocess.run(command, cwd=folder, check=True)


if __name__ == "__main__":
    os.environ["DH2URDF_ENGINE"] = "python"
    try:
        compiled()
    except Exception as error:
        print(error, file=sys.stderr)
        sys.exit(3)
