"""Run the notebooks: ``python examples/notebooks/execute.py [--write] [NAME.ipynb ...]``.

Each runs in a fresh kernel in a folder of its own; the first cell that fails ends it. With
``--write`` the outputs are kept in the file, pictures with 128 colours.
"""

import argparse
import base64
import io
import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).parent

SECONDS = 60
"""Most that a cell may take."""


def executed(path: Path) -> nbformat.NotebookNode:
    """The notebook with the outputs of a run.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
    """
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        resources = {"metadata": {"path": folder}}
        client = NotebookClient(notebook, timeout=SECONDS, resources=resources)
        client.coalesce_streams = True
        client.execute()
    return notebook


def tidied(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Small outputs, and nothing that is another one at each run."""
    for cell in notebook.cells:
        cell.metadata.clear()
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "image/png" in data:
                data["image/png"] = _fewer_colours(data["image/png"])
            if len(data) > 1:
                data.pop("text/plain", None)
    notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python"}}
    notebook.metadata["kernelspec"]["name"] = "python3"
    return notebook


def _fewer_colours(text: str) -> str:
    from PIL import Image

    picture = Image.open(io.BytesIO(base64.b64decode(text))).convert("RGB")
    out = io.BytesIO()
    picture.quantize(128).save(out, "png", optimize=True)
    return base64.b64encode(out.getvalue()).decode()


def main() -> None:
    """Run the notebooks that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="keep the outputs in the files")
    parser.add_argument("names", nargs="*", type=Path)
    asked = parser.parse_args()
    for path in asked.names or sorted(FOLDER.glob("*.ipynb")):
        notebook = executed(path)
        if asked.write:
            nbformat.write(tidied(notebook), path)
        sys.stdout.write(f"{path.name}: {path.stat().st_size // 1024} kB\n")


if __name__ == "__main__":
    main()
