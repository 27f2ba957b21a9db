"""``dh2urdf check``: what the consumers of a URDF would say of it."""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from itertools import count
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.checks import ask_all, check_urdf, installed, why_not_asked
from dh2urdf.checks.findings import Finding
from dh2urdf.checks.formats import REPORTS, Checked, Unread, plain_text
from dh2urdf.checks.mends import certain_mends
from dh2urdf.cli.options import Json
from dh2urdf.cli.output import emit, emit_file, emit_json, stdin
from dh2urdf.cli.progress import bar, note
from dh2urdf.cli.reading import PLAIN, Description
from dh2urdf.conversions.read import description_bytes, is_xacro, mended_urdf, xacro_given
from dh2urdf.dh_io import atomic_write, refuse_foreign
from dh2urdf.dh_io.files import read_bytes
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError

MENDED = "mended by dh2urdf"
"""Comment by which a mended file is known as ours."""


def check_(
    *files: str,
    run: Annotated[bool, Parameter(negative="--no-run")] = True,
    fix: Path | None = None,
    base: str | None = None,
    tip: str | None = None,
    force: bool = False,
    format: Literal["text", "json", "sarif", "junit", "html"] = "text",
    reading: Description = PLAIN,
    json: Json = False,
) -> int:
    """Say what the consumers of a URDF would say of it, and how to mend it.

    Pinocchio, check_urdf, yourdfpy, MuJoCo, PyBullet, Drake, ikpy, KDL, Gazebo, MoveIt, IKFast
    and RViz each break on other things. Rules tell what, line by line; those of the programs
    that are installed are asked too, about files of up to 200 joints. Exit status 0: no errors
    or warnings, 1: some, 2: a file that cannot be read.

    Parameters
    ----------
    files
        URDF or xacro files, from anywhere; - for stdin. Lines of a xacro are those of the URDF
        that it expands to.
    run
        Load the files in the consumers that are installed.
    fix
        Write the file here with all mended that takes no guess, say what that was, and what is
        left to mend. With --force this may be the file itself.
    base, tip
        Links of the arm that --fix may not guess about; without them the root, and the end of
        the longest chain.
    force
        Replace a file that this package did not write.
    format
        sarif and junit are for build servers, html is one page; all go to stdout.
    """
    if not files:
        raise Dh2UrdfError("check: FILES: name one or more; - for stdin")
    if fix is not None:
        return _mend(files, fix, base, tip, reading, force=force, json=json)
    results, failed, done = list[Checked](), list[Unread](), count(1)
    total = len(files) * (1 + run * len(installed()))
    with bar("checking", total) as report:

        def step() -> None:
            report(next(done), total)

        for file in files:
            try:
                results.append(_result(file, run, step, reading))
            except Dh2UrdfError as error:
                failed.append(Unread(file, str(error)))
            step()
    if json or format == "json":
        emit_json("check", files=list(map(_data, results)), failed=[f._asdict() for f in failed])
    elif format == "text":
        for result in results:
            emit(plain_text(result))
    else:
        emit_file(REPORTS[format](results, failed))
    for bad in failed:
        note(f"dh2urdf: {bad.error}")
    return 2 if failed else int(any(result.wrong for result in results))


def _finding(finding: Finding) -> dict[str, Any]:
    return {"severity": finding.severity, **asdict(finding)}


def _data(result: Checked) -> dict[str, Any]:
    """What is said of a file, for JSON."""
    return {
        "path": result.file,
        "findings": [_finding(f) for f in result.findings],
        "consumers": [asdict(t) for t in result.said],
        "not_asked": result.not_asked,
    }


def _result(file: str, run: bool, answered: Callable[[], None], reading: Description) -> Checked:
    with _on_disk(file, reading) as path:
        findings = check_urdf(path if file == "-" else file, **reading.given)
        why = why_not_asked(path) if run else ""
        said = ask_all(path, None, answered) if run and not why else ()
    return Checked("<stdin>" if file == "-" else file, findings, said, why)


def _mend(
    files: tuple[str, ...],
    fix: Path,
    base: str | None,
    tip: str | None,
    reading: Description,
    *,
    force: bool,
    json: bool,
) -> int:
    if len(files) != 1:
        raise ArgumentError(f"--fix: expected one file to mend, got {len(files)}")
    with _on_disk(files[0], reading) as path:
        source = path if files[0] == "-" else files[0]
        text, mends = mended_urdf(source, base, tip, xacro_given(**reading.given))
    text, certain = certain_mends(text, base, tip, "stdin" if files[0] == "-" else files[0])
    mends += certain
    if not force:
        refuse_foreign(fix, MENDED)
    atomic_write(fix, f"<!--{MENDED}-->\n{text}\n")
    left = check_urdf(fix, packages=reading.given["packages"])
    if json:
        emit_json("check", fixed=fix, mends=mends, left=[_finding(f) for f in left])
    else:
        emit("\n".join([*mends, f"{fix}: written, {len(mends)} mended, and read back"]))
        if left:
            emit(f"left to mend:\n\n{plain_text(Checked(str(fix), left))}")
    return 0


@contextmanager
def _on_disk(file: str, reading: Description) -> Iterator[Path]:
    """Path of a URDF; what comes by stdin, or of a xacro, is put into one."""
    piped = file == "-"
    if not piped and not is_xacro(file):
        yield Path(file)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{'stdin' if piped else Path(file).stem}.urdf"
        given = xacro_given(**reading.given)
        data = read_bytes(stdin(), ROBOT_BYTES) if piped else description_bytes(file, given)[0]
        path.write_bytes(data)
        yield path
