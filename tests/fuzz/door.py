"""A door of the package as fuzzing sees it: bytes go in, an answer or one message comes out."""

import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from hypothesis import strategies as st

CORPUS = Path(__file__).parent / "corpus"
WORDS = Path(__file__).parent / "words"

LONG = [b"9" * 400, b"a" * 3000, b"[" * 200, b"\xff\xfe", b"\xc3", b"\r\n", b"\n", b" ", b"\t", b""]

VALUE = re.compile(rb"[-+\w.]+|'[^'\n]*'|\"[^\"\n]*\"")

Edit = tuple[int, int, int, bytes]


class Door(NamedTuple):
    """Where something comes in.

    Parameters
    ----------
    name : str
    enter : callable
        Takes the input and a folder to work in, which it leaves empty; it raises where the door
        did anything but answer or refuse.
    words : tuple of str
        Files of ``words/`` with what edits put in, beside ``common.txt``.
    seeds : tuple of bytes
        Beside the files of the corpus.
    usual : int
        Inputs in the default suite.
    shaped : strategy, optional
        Inputs of the door's own making, every second one.
    """

    name: str
    enter: Callable[[bytes, Path], None]
    words: tuple[str, ...] = ()
    seeds: tuple[bytes, ...] = ()
    usual: int = 2000
    shaped: st.SearchStrategy[bytes] | None = None

    @property
    def kept(self) -> list[Path]:
        """Files of the corpus."""
        return sorted((CORPUS / self.name).glob("*"))

    @property
    def starts(self) -> list[bytes]:
        """What edits begin with."""
        return [*self.seeds, *(path.read_bytes() for path in self.kept)]

    @property
    def tokens(self) -> list[bytes]:
        """What edits put in; signs that are not ASCII's are written by escapes there."""
        files = [WORDS / f"{name}.txt" for name in ("common", *self.words)]
        words = " ".join(path.read_text(encoding="ascii") for path in files).split()
        spelt = [re.sub(r"\\(u\w{4}|x\w\w|\\)", _sign, word) for word in words]
        return [*LONG, *(word.encode("utf-8", "surrogatepass") for word in spelt)]

    def inputs(self) -> st.SearchStrategy[bytes]:
        """Seeds with a few edits, and what has a shape of its own."""
        word = st.one_of(st.sampled_from(self.tokens), st.binary(max_size=6))
        one = st.tuples(st.integers(0, 7), st.integers(0, 4000), st.integers(0, 30), word)
        changed = st.builds(edited, st.sampled_from(self.starts), st.lists(one, max_size=6))
        return changed if self.shaped is None else st.one_of(changed, self.shaped)


def some_edits(rng: random.Random, words: list[bytes]) -> list[Edit]:
    """A few edits, mostly one."""
    return [
        (rng.randrange(8), rng.randrange(4000), rng.randrange(30), rng.choice(words))
        for _ in range(rng.choice([1, 1, 2, 4]))
    ]


def _sign(escape: re.Match[str]) -> str:
    """The sign that an escape stands for."""
    return "\\" if escape[1] == "\\" else chr(int(escape[1][1:], 16))


def edited(text: bytes, edits: list[Edit]) -> bytes:
    """A text with values, stretches and lines changed: how, where, how much, by what."""
    for how, at, size, word in edits:
        lines = text.split(b"\n")
        k = at % len(lines)
        if how < 4 and (found := list(VALUE.finditer(text))):
            place = found[at % len(found)]
            text = text[: place.start()] + word + text[place.end() :]
        elif how == 4:
            text = b"\n".join(lines[:k] + lines[k + 1 :])
        elif how == 5:
            text = b"\n".join(lines[: k + 1] + lines[k:])
        elif how == 6:
            text = b"\n".join([*lines[:k], word, *lines[k:]])
        else:
            place = at % (len(text) + 1)
            text = text[:place] + word + text[place + size :]
    return text
