"""The build hook: kernels are written as C and compiled, into a wheel or an editable checkout."""

import os
import shutil
import sys
import sysconfig
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class KernelsHook(BuildHookInterface):
    """What hatchling calls before it packs a wheel."""

    def dependencies(self) -> list[str]:
        """The system's compiler is taken; without one, the compiler that comes as a wheel."""
        found = any(map(shutil.which, ("cc", "gcc", "clang")))
        return ["numpy>=1.26", *([] if found else ["ziglang>=0.13"])]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and say that the wheel is of this platform, for Python 3.11 and later."""
        os.environ["DH2URDF_ENGINE"] = "python"
        sys.path.insert(0, self.root)
        from dh2urdf.translate.build import PLACE, build

        build()
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["pure_python"] = False
        build_data["tag"] = f"cp311-abi3-{platform}"
        build_data["artifacts"].append(f"dh2urdf/{PLACE.name}")
