"""Runs every block of a page when it is read, and puts what it prints below it.

``sh`` and ``python`` blocks run; a ``{code-block}`` with a caption is saved under that name;
``{generated} NAME`` stands for what the function of that name of ``generated.py`` returns;
a mark ``hidden`` runs a block without showing it, ``prose`` wraps what it prints, ``page``
makes it part of the page. Pictures that blocks wrote may be shown by
their bare names. Files in ``files/`` beside the page lie in the folder where its blocks run.
"""

import os
import re
import shutil
from pathlib import Path

import generated
from blocks import Block, Runner, blocks
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

PICTURE = re.compile(r"[\w-]+\.(png|svg)")
LINK = re.compile(r"(?<=\]\()([\w.-]+)(?=\))")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension."""
    app.connect("source-read", _read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _read(app: Sphinx, docname: str, source: list[str]) -> None:
    page = Path(app.srcdir) / docname
    folder = Path(app.srcdir) / "_build" / "run" / docname
    shutil.rmtree(folder, ignore_errors=True)
    if (page.parent / "files").is_dir():
        shutil.copytree(page.parent / "files", folder)
    folder.mkdir(parents=True, exist_ok=True)
    source[0] = _filled(source[0], Runner(folder), docname)
    up = os.path.relpath(folder, page.parent)

    def moved(name: re.Match[str]) -> str:
        made = (folder / name[1]).is_file() and not (page.parent / name[1]).exists()
        return f"{up}/{name[1]}" if made else name[1]

    source[0] = LINK.sub(moved, source[0])


def _filled(text: str, runner: Runner, docname: str) -> str:
    """The page with what its blocks print."""
    parts, last = [], 0
    for block in blocks(text):
        try:
            shown = _shown(text[block.start : block.end], block, runner)
        except Exception as error:
            raise ExtensionError(f"{docname}: {error}\n{block.text}", error) from error
        parts += [text[last : block.start], shown]
        last = block.end
    return "".join([*parts, text[last:]])


def _shown(source: str, block: Block, runner: Runner) -> str:
    if block.kind.startswith("{generated}"):
        name, *arguments = block.kind.split()[1:]
        return str(getattr(generated, name)(*arguments))
    if block.mark.startswith("not run: "):
        return f"{source}\n\n*Not run here: {block.mark.removeprefix('not run: ')}.*"
    output = runner(block).strip("\n")
    if block.mark == "hidden":
        return ""
    if not output or re.fullmatch(PICTURE, output):  # whose name stands in the command
        return source
    if block.mark == "page":
        return f"{source}\n\n{output}\n"
    kind = "output prose" if block.mark == "prose" else "output"
    return f"{source}\n\n```{{code-block}} text\n:class: {kind}\n\n{output}\n```"
