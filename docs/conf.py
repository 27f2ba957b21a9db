"""Settings of the documentation site: ``sphinx-build -W -j 2 docs docs/_build/html``."""

import sys
from pathlib import Path

import ziamath

import dh2urdf

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "extensions"), str(HERE.parent)]  # "..": benchmarks and tests/helpers

project = "dh2urdf"
author = copyright = "the dh2urdf developers"
release = dh2urdf.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "mathml",
    "run_blocks",
    "solver_page",
]
exclude_patterns = ["_build", "schemas", "**/files"]
myst_enable_extensions = ["attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
copybutton_selector = "div:not(.output) > div.highlight > pre"
smartquotes = False  # options begin with two hyphens
autodoc_typehints = "none"  # docstrings say types, shapes and units
napoleon_use_ivar = True
suppress_warnings = ["ref.python"]  # words of types, such as the n of a shape, that are names, too

html_theme = "furo"
html_title = "dh2urdf"
html_math_renderer = "mathml"
html_static_path = ["static", str(Path(ziamath.__file__).parent / "fonts/STIXTwoMath-Regular.ttf")]
html_css_files = ["site.css"]
html_show_search_summary = False  # its excerpts are fetched, which browsers refuse to file://
html_show_sourcelink = False
html_copy_source = False
templates_path: list[str] = []
