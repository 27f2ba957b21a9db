import os
import subprocess
import sys

import pytest

from tests.translate import golden, workload
from tests.translate.record import interpreted

FAMILIES = "puma560", "ur5", "stanford", "omron_cobra600", "fanuc_crx10ia", "franka_fer"

SLICE = {"numbers": None, "planar_rr": 3, "three slides": 2, **dict.fromkeys(FAMILIES, 2)}
"""An arm a family, and how many of its tasks are answered by the kernels as they are written."""


@pytest.mark.parametrize("arm", workload.arms())
def test_answers_are_the_golden_ones(arm):
    """Every bit of every answer is what the file says: ``python -m tests.translate.golden``."""
    assert list(golden.lines(arm)) == golden.kept()[arm]


@pytest.mark.parametrize("arm", SLICE)
def test_interpreted_kernels_give_the_golden_answers(arm):
    """The kernels as they are written give the bits that compiled ones gave."""
    with interpreted():
        assert list(golden.lines(arm, SLICE[arm])) == golden.kept()[arm][: SLICE[arm]]


OLD = {
    "OPENBLAS_CORETYPE": "Nehalem",
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX2 FMA3 AVX512F AVX512_SKX",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable",
    "DH2URDF_ENGINE": "compiled",
    "DH2URDF_LEVEL": "any",
}
"""Settings under which libraries, and the kernels, do as on an old processor."""


def check_old(arms):
    """The golden answers come out of a process that takes the processor for an old one."""
    words = [sys.executable, "-W", "ignore", "-m", "tests.translate.golden", *arms]
    done = subprocess.run(words, env=os.environ | OLD, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_old_processors_give_the_golden_answers():
    """No library's choice of instructions decides a bit, on an arm of each kind."""
    check_old(["cylindrical_wrist", "fanuc_crx10ia", "franka_fer", "puma560~", "ur10", "xarm5"])


TABLES = """
import pkgutil, numpy as np
from hashlib import md5
from importlib import import_module
import dh2urdf.kernels as kernels
from dh2urdf.kernels.general_6r import tables_of
for degree in (16, 48):
    for name, table in tables_of(degree).items():
        print(degree, name, md5(np.ascontiguousarray(table).tobytes()).hexdigest())
for module in pkgutil.walk_packages(kernels.__path__, kernels.__name__ + "."):
    for name, table in vars(import_module(module.name)).items():
        if isinstance(table, np.ndarray):
            print(module.name, name, md5(np.ascontiguousarray(table).tobytes()).hexdigest())
"""


@pytest.mark.parametrize("core", ["Nehalem", "Haswell", "SkylakeX"])
def test_kernels_tables_are_the_same_on_old_processors(core):
    """What is compiled in does not depend on where: not on BLAS, not on NumPy's vector code."""
    words, seen = [sys.executable, "-c", TABLES], []
    for settings in {}, OLD | {"OPENBLAS_CORETYPE": core}:
        env = os.environ | settings | {"DH2URDF_ENGINE": "python"}
        seen.append(subprocess.run(words, env=env, capture_output=True, text=True, check=True))
    assert "WINDOW_8" in seen[0].stdout
    assert seen[0].stdout == seen[1].stdout


@pytest.mark.exhaustive
def test_old_processors_give_all_golden_answers():
    """The same on all arms."""
    check_old(workload.arms())


def test_file_names_all_arms():
    """No arm is left out, none is there that is gone."""
    assert list(golden.kept()) == workload.arms()
