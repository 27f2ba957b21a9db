"""Compile the kernels as soon as can be, of a package that stands elsewhere, and compare answers.

``python -m tests.mutation.compiled``, where ``dh2urdf`` is the changed package, ends with 3 where
that cannot be translated, and with 1 at the first answer that is not the golden one.
"""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

FIRST = ["numbers", "planar_rr", "puma560", "ur5", "stanford", "franka_fer", "xarm5"]
FIRST += ["cylindrical", "abb_irb120~", "gantry", "fanuc_crx10ia"]
"""Arms that are asked first: most changes show in them."""


def compiled() -> None:
    """The extension without optimization, its code for any processor in the place of others."""
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


def differs() -> bool:
    """Whether an answer is another one; stops at the first."""
    from tests.translate import golden, workload

    kept = golden.kept()
    rest = [arm for arm in workload.arms() if arm not in FIRST]
    return any(line not in kept[arm] for arm in [*FIRST, *rest] for line in golden.lines(arm))


if __name__ == "__main__":
    if sys.argv[1:]:
        sys.exit(differs())
    try:
        os.environ["DH2URDF_ENGINE"] = "python"
        compiled()
    except Exception as error:
        print(error, file=sys.stderr)
        sys.exit(3)
    os.environ["DH2URDF_ENGINE"] = "compiled"
    again = [sys.executable, "-m", "tests.mutation.compiled", "answers"]
    sys.exit(subprocess.run(again, check=False).returncode)
