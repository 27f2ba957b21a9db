"""The documentation site, built where it is not there yet."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HTML = ROOT / "docs" / "_build" / "html"


@pytest.fixture(scope="session")
def site():
    """The folder of the built pages."""
    if not (HTML / "index.html").is_file():
        pytest.importorskip("furo", reason="pip install -e '.[docs]'")
        build = [sys.executable, "-m", "sphinx", "-W", "-q", "-j", "2", "docs", str(HTML)]
        subprocess.run(build, cwd=ROOT, check=True)
    return HTML


@pytest.fixture(scope="session")
def pages(site):
    """Every page, by its path within the site."""
    return sorted(path.relative_to(site) for path in site.rglob("*.html"))
