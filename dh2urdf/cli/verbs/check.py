"""``dh2urdf check``: what the consumers of a URDF would say of it."""

import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from itertools import count
from pathlib import Path
from typing import Annotated, NamedTuple

from cyclopts import Parameter

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.checks import Testimony, ask_all, check_urdf, installed, why_not_asked
from dh2urdf.checks.findings import Effect, Finding, Severity, Verdict
from dh2urdf.cli.options import Json
from dh2urdf.cli.output import emit, emit_json, stdin
from dh2urdf.cli.progress import bar, note
from dh2urdf.cli.reading import PLAIN, Description
from dh2urdf.conversions.read import description_bytes, is_xacro, mended_urdf, xacro_given
from dh2urdf.dh_io import atomic_write, refuse_foreign
from dh2urdf.dh_io.files import read_bytes
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError

MENDED = "mended by dh2urdf"
"""Comment by which a mended file is known as ours."""

SHOWN = 4
"""Findings of one kind that are shown in full; the rest by line."""


def check_(
    *files: str,
    run: Annotated[bool, Parameter(negative="--no-run")] = True,
    fix: Path | None = None,
    base: str | None = None,
    tip: str | None = None,
    force: bool = False,
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
        Write the file here with all that has an obvious reading mended, and say what that was;
        what is left to mend, a check of that file tells.
    base, tip
        Links of the arm that --fix may not guess about; without them the root, and the end of
        the longest chain.
    force
        Replace a file that this package did not write.
    """
    if not files:
        raise Dh2UrdfError("check: FILES: name one or more; - for stdin")
    if fix is not None:
        return _mend(files, fix, base, tip, reading, force=force, json=json)
    results, failed, done = [], [], count(1)
    total = len(files) * (1 + run * len(installed()))
    with bar("checking", total) as report:

        def step() -> None:
            report(next(done), total)

        for file in files:
            try:
                results.append(_result(file, run, step, reading))
            except Dh2UrdfError as error:
                failed.append({"path": file, "error": str(error)})
            step()
    if json:
        data = [
            {
                "path": result.file,
                "findings": [{"severity": f.severity, **asdict(f)} for f in result.findings],
                "consumers": [asdict(t) for t in result.said],
                "not_asked": result.not_asked,
            }
            for result in results
        ]
        emit_json("check", files=data, failed=failed)
    else:
        for result in results:
            _show(result)
    for bad in failed:
        note(f"dh2urdf: {bad['error']}")
    wrong = (
        any(f.severity is not Severity.ADVICE for f in result.findings)
        or any(t.verdict is Verdict.REFUSES for t in result.said)
        for result in results
    )
    return 2 if failed else int(any(wrong))


class _Result(NamedTuple):
    """What is said of one file, and why no consumer was asked, where none was."""

    file: str
    findings: tuple[Finding, ...]
    said: tuple[Testimony, ...]
    not_asked: str


def _result(file: str, run: bool, answered: Callable[[], None], reading: Description) -> _Result:
    with _on_disk(file, reading) as path:
        findings = check_urdf(path if file == "-" else file, **reading.given)
        why = why_not_asked(path) if run else ""
        said = ask_all(path, None, answered) if run and not why else ()
    return _Result("<stdin>" if file == "-" else file, findings, said, why)


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
    if not force:
        refuse_foreign(fix, MENDED)
    atomic_write(fix, f"<!--{MENDED}-->\n{text}\n")
    if json:
        emit_json("check", fixed=fix, mends=mends)
    else:
        emit("\n".join([*mends, f"{fix}: written, {len(mends)} mended, and read back"]))
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


def _show(result: _Result) -> None:
    file, findings, said, not_asked = result
    alike: dict[tuple[str, tuple[Effect, ...]], list[Finding]] = {}
    for finding in findings:
        alike.setdefault((finding.rule, finding.effects), []).append(finding)
    for group in alike.values():
        _show_group(file, group)
    counts = Counter(f.severity for f in findings)
    plural = {s: "s" if counts[s] > 1 and s is not Severity.ADVICE else "" for s in Severity}
    summary = ", ".join(f"{counts[s]} {s}{plural[s]}" for s in Severity if counts[s])
    emit(f"{file}: {summary or 'nothing to mend'}")
    for testimony in said:
        name = f"{testimony.consumer} {testimony.version}".rstrip()
        words = testimony.words.replace("\n", f"\n{' ' * 33}")
        emit(f"    {name:<17} {testimony.verdict:<11}{words}".rstrip())
    if not_asked:
        emit(f"    no program was asked: {not_asked}")


def _show_group(file: str, group: list[Finding]) -> None:
    """Findings of one rule and one effect: each on its line, then what they have in common."""
    for f in group[:SHOWN]:
        emit(f"{file}:{f.line}: {f.severity}: {f.element} {f.message} [{f.rule}]")
    if len(group) > SHOWN:
        lines = ", ".join(str(f.line) for f in group[SHOWN : 4 * SHOWN])
        dots = ", ..." if len(group) > 4 * SHOWN else ""
        emit(f"    and {len(group) - SHOWN} more of the kind, on lines {lines}{dots}")
    for effect in group[0].effects:
        emit(f"    {_sentence(effect)}")
    emit(f"    mend: {group[0].mend}\n")


def _sentence(effect: Effect) -> str:
    """``MuJoCo and Drake refuse the file: axis too small``."""
    names = [str(consumer) for consumer in effect.consumers]
    who = names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
    s = "s" if len(names) == 1 else ""
    does = {
        Verdict.REFUSES: f" refuse{s} the file",
        Verdict.COMPLAINS: f" complain{s}",
        Verdict.MISREADS: f" misread{s} it",
        Verdict.ACCEPTS: "",
    }[effect.verdict]
    return f"{who}{does}: {effect.text}" if effect.text else f"{who}{does}"
