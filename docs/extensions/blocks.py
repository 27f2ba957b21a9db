"""Blocks of Markdown pages: what they are, and what they print when they run."""

import contextlib
import io
import os
import re
import subprocess
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

__all__ = ["Block", "Runner", "blocks", "run"]

BLOCK = re.compile(
    r"^(?:<!-- (?P<mark>[^\n]+?) -->\n)?(?P<fence>```+)(?P<kind>[^\n]*)\n"
    r"(?::caption: (?P<file>\S+)\n\n?)?(?P<text>.*?)^(?P=fence)[ ]*$",
    re.S | re.M,
)
STATUS = re.compile(r"status (\d+)")
WIDTH = "88"
"""Columns that commands may fill."""


@dataclass(frozen=True)
class Block:
    """A fenced block: the word behind its fence, its text, a comment above it as its mark.

    ``file`` is the name under which a ``{code-block}`` with a caption is saved.
    """

    kind: str
    text: str
    mark: str
    file: str
    start: int
    end: int

    def commands(self) -> list[str]:
        """The commands of a shell block, lines that end with a backslash joined."""
        lines = self.text.replace("\\\n", " ").splitlines()
        return [line for line in lines if line.strip() and not line.startswith("#")]


def blocks(page: str) -> Iterator[Block]:
    """All fenced blocks of a page, in order."""
    for found in BLOCK.finditer(page):
        part = found.groupdict(default="")
        yield Block(part["kind"], part["text"], part["mark"], part["file"], *found.span())


def run(command: list[str] | str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command of a page with this interpreter's programs; a string is for the shell."""
    here = os.environ | {
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        "COLUMNS": WIDTH,
        "NO_COLOR": "1",
    }
    return subprocess.run(
        command,
        shell=isinstance(command, str),
        cwd=folder,
        env=here,
        capture_output=True,
        text=True,
        check=False,
    )


class Runner:
    """Runs the blocks of one page one after the other, in one folder and one namespace."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.names: dict[str, Any] = {"__name__": "__main__"}

    def __call__(self, block: Block) -> str:
        """What a block prints: of commands the standard output, the other where that is empty.

        Raises
        ------
        RuntimeError
            A command ends with another status than 0, or than the mark ``status N`` says.
        """
        if block.file:
            path = self.folder / block.file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")
            return ""
        if block.kind == "sh":
            return self._shell(block)
        return self._python(block) if block.kind == "python" else ""

    def _shell(self, block: Block) -> str:
        commands, said = block.commands(), re.fullmatch(STATUS, block.mark)
        status, printed = int(said[1]) if said else 0, []
        for command in commands:
            done = run(command, self.folder)
            if done.returncode != status:
                raise RuntimeError(f"{command}: status {done.returncode}\n{done.stderr}")
            text = done.stdout or done.stderr
            printed.append(f"$ {command}\n{text}" if len(commands) > 1 else text)
        return "\n".join(printed)

    def _python(self, block: Block) -> str:
        out = io.StringIO()
        code = compile(block.text, "<page>", "exec")
        with (
            contextlib.redirect_stdout(out),
            contextlib.chdir(self.folder),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("error")
            exec(code, self.names)
        return out.getvalue()
