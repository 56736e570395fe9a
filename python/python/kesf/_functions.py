"""The functions of the package."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, overload

from . import _kesf
from ._calls import case_of, follower, sources, text_of
from ._errors import KesfError, KesfWarning, failures_of, findings_of
from ._fabrics import Batch, Fabric
from ._reports import Comparison, Run, Verification, comparison_of, run_of
from ._sections import Card, Section, assumptions_of
from ._sheets import Sheet, Sheets
from ._solutions import Drape, Solution, drape_of, solution_of
from ._types import CaseLike, Path, Progress, SettingsLike

#: What can be read: a path, bytes, a pair of a name and bytes.
Readable = Path | bytes | tuple[str, bytes]

#: What has a section or can be given one.
Cloth = Section | Sheet | Fabric | Path


class _Options(NamedTuple):
    """How files are read where they do not say it themselves."""

    dialect: str | None
    delimiter: str | None
    decimal: str | None
    assume_kes_units: bool


class _Making(NamedTuple):
    """How results are made and where they go."""

    out: str | None
    keep: bool
    charts: bool
    formats: list[str]
    xlsx: bool
    drape: bool | None
    stamp: str | None
    force: bool
    solver: str | None
    settings: str | None


def _options(dialect: Path | None, delimiter: str | None, decimal: str | None, kes: bool) -> _Options:
    for name, mark in (("delimiter", delimiter), ("decimal", decimal)):
        if mark is not None and len(mark) != 1:
            raise KesfError(f"the {name} `{mark}` is not one character")
    if decimal not in (None, ".", ","):
        raise KesfError(f"the decimal mark `{decimal}` is none", cure='take "." or ","')
    return _Options(None if dialect is None else os.fspath(dialect), delimiter, decimal, kes)


def read(
    inputs: Readable | Iterable[Readable],
    *,
    dialect: Path | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    assume_kes_units: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Batch:
    """Reads measurement files: what they say, in SI, and nothing computed.

    Args:
        inputs: Folders of fabrics, measurement files, bytes of a file, pairs of a name and bytes, or several of these.
        dialect: TOML file that describes the layout of a laboratory; tried first.
        delimiter: Cell delimiter, one character; inferred when None.
        decimal: Decimal mark, ``.`` or ``,``; inferred when None.
        assume_kes_units: Take numbers without a unit as being in the customary KES unit.
        threads: Threads of the work; all of the machine when None.
        progress: A bar such as ``tqdm.tqdm()``, or a function of what is done, steps done and steps in all.

    Returns:
        The fabrics in name order. What could not be read is in ``failures`` and costs the others nothing.

    Raises:
        KesfError: if nothing at all could be read; ``failures`` of the exception has every reason.

    >>> import kesf
    >>> kesf.read("kesf_data/poplin")
    <kesf.Batch: 1 fabrics, 0 findings, 0 failures>
    """
    paths, memory = sources(inputs)
    options = _options(dialect, delimiter, decimal, assume_kes_units)
    native, findings, failed = _kesf.read(paths, memory, options, threads, follower(progress))
    failures = failures_of(failed)
    if failures and not native:
        error = failures[0].error()
        error.failures = failures
        raise error
    return Batch([Fabric(fabric) for fabric in native], findings_of(findings), failures)


@overload
def characterise(
    fabric: Fabric,
    settings: SettingsLike | None = None,
    *,
    moduli: Sequence[str] = (),
    threads: int | None = None,
    progress: Progress | None = None,
) -> Sheet: ...
@overload
def characterise(
    fabric: Batch | Sequence[Fabric],
    settings: SettingsLike | None = None,
    *,
    moduli: Sequence[str] = (),
    threads: int | None = None,
    progress: Progress | None = None,
) -> Sheets: ...
@overload
def characterise(
    fabric: Path,
    settings: SettingsLike | None = None,
    *,
    moduli: Sequence[str] = (),
    threads: int | None = None,
    progress: Progress | None = None,
) -> Sheet: ...
def characterise(
    fabric: Fabric | Batch | Sequence[Fabric] | Path,
    settings: SettingsLike | None = None,
    *,
    moduli: Sequence[str] = (),
    threads: int | None = None,
    progress: Progress | None = None,
) -> Sheet | Sheets:
    """The KES parameters of a fabric, or of each fabric of a batch: mean, standard deviation and number of repeats.

    Args:
        fabric: A fabric, a batch, or the path of one fabric.
        settings: Windows and thresholds of the evaluation: a TOML file, its bytes, or its keys and values; the
            customary ones when None.
        moduli: Tensile moduli to be evaluated beside those of the settings, such as ``window(5 gf/cm, 20 gf/cm)``.
        threads: Threads of the work; all of the machine when None.
        progress: A bar such as ``tqdm.tqdm()``, or a function of what is done, steps done and steps in all.

    Returns:
        A sheet, or the sheets of a batch. What cannot be evaluated is left out and told in the findings of the sheet.
        Files of a path that cannot be read are left out with a :class:`KesfWarning` each; of a batch they are its
        ``failures``.

    Raises:
        KesfError: if the settings cannot be used, or the path is not that of one fabric.

    >>> import kesf
    >>> sheet = kesf.characterise("kesf_data/poplin", {"bending_slope": ["0.5 1/cm", "1.0 1/cm"]})
    >>> sheet.settings["B fitted over"]
    '0.5 1/cm .. 1 1/cm'
    """
    one = isinstance(fabric, (Fabric, str, os.PathLike))
    if isinstance(fabric, (str, os.PathLike)):
        fabric = _only(read(fabric), os.fspath(fabric))
    several = [fabric] if isinstance(fabric, Fabric) else list(fabric) if isinstance(fabric, Iterable) else [fabric]
    strange = [type(each).__name__ for each in several if not isinstance(each, Fabric)]
    if strange:
        raise KesfError(f"{strange[0]} is no fabric", cure="give kesf.read(...), or the path of one fabric")
    moduli = [moduli] if isinstance(moduli, str) else moduli
    text = None if settings is None else text_of(settings, "<settings>", "the settings")
    native = [f._native for f in several]
    sheets = _kesf.characterise(native, text, list(moduli), threads, follower(progress))
    made = [Sheet(sheet) for sheet in sheets]
    return made[0] if one else Sheets(made, fabric.failures if isinstance(fabric, Batch) else ())


def _only(batch: Batch, path: str) -> Fabric:
    if len(batch) == 1:
        for failure in batch.failures:
            text = f"{failure}; what it holds is not in the result"
            warnings.warn(text, KesfWarning, stacklevel=_outside())
        return batch[0]
    raise KesfError(
        f"there are {len(batch)} fabrics, and one is expected",
        code="O055",
        path=path,
        cure="give kesf.read(path) for all of them, or kesf.read(path)[name] for one",
    )


def _outside() -> int:
    """How many calls up the first one is that is not of this package: a warning is for its line."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __package__:
        frame, level = frame.f_back, level + 1
    return level


def _sheet(cloth: Sheet | Fabric | Path) -> Sheet:
    if isinstance(cloth, (Fabric, str, os.PathLike)):
        return characterise(cloth)
    if not isinstance(cloth, Sheet):
        raise KesfError(
            f"{type(cloth).__name__} is not one fabric",
            cure="give a sheet, a fabric, or the path of one; of several, one after the other",
        )
    return cloth


def section(sheet: Sheet | Fabric | Path, **assumptions: Any) -> Section:
    """The shell section of a fabric: membrane, bending and shear stiffness, with every assumption listed.

    Args:
        sheet: A sheet; a fabric or path is characterised first, with customary settings.
        **assumptions: The keys of ``[assumptions]`` of a case, with the same texts and defaults: ``modulus``,
            ``poisson``, ``poisson_rule``, ``torsion``, ``bending_coupling``, ``transverse_shear``, ``law``,
            ``residual_curvature``, ``tensile``, ``shear``, ``shear_tension``, ``thickness``, ``areal_density``.

    Raises:
        KesfError: if the sheet lacks what a section needs, an assumption is none, or the stiffness is not positive.

    >>> import kesf
    >>> section = kesf.section("kesf_data/poplin", poisson=0.0, torsion="3e-6 N·m")
    >>> float(section.d_b[2, 2]), float(section.d_m[0, 1])
    (3e-06, 0.0)
    """
    return Section(_kesf.Section.of(_sheet(sheet)._native, assumptions_of(assumptions)))


def _simulate(kind: str, case: CaseLike, cloth: Cloth | None, threads: int | None, progress: Progress | None) -> Any:
    path, text = case_of(case)
    native = None
    if cloth is not None:
        native = cloth._native if isinstance(cloth, Section) else _sheet(cloth)._native
    return _kesf.simulate(kind, path, text, native, threads, follower(progress))


def solve(
    case: CaseLike,
    section: Cloth | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Solves a case with a ``[sheet]``.

    Args:
        case: A case file, the bytes of one, or its tables as nested mappings.
        section: A section, whose own assumptions stand; or a sheet, fabric or path, with the assumptions of the case.
            Whatever fabric the case names, this one is taken. None for a case with a ``[section]`` of its own, or with
            the fabric that it names.
        threads: Threads of the work; all of the machine when None. The result does not depend on it.
        progress: A bar such as ``tqdm.tqdm()``, or a function of what is done, steps done and steps in all.

    Raises:
        KesfError: at the place in the case file, if there is no solution.

    >>> import kesf
    >>> section = kesf.section("kesf_data/poplin")
    >>> solution = kesf.solve("cases/seed_clamped.toml", section)
    >>> solution.fabric, solution.w_max > 0.0, solution.moment.shape == (len(solution.mesh.nodes), 3)
    ('poplin', True, True)
    """
    return solution_of(_simulate("solve", case, section, threads, progress))


def compare(
    case: CaseLike,
    sheet: Cloth | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Comparison:
    """Simulates an instrument test, a case with a ``[virtual_test]`` or ``[bending_test]``, beside its measurement.

    The arguments are those of :func:`solve`.

    >>> import kesf
    >>> kesf.compare("cases/virtual_shear.toml", kesf.characterise("kesf_data/poplin")).fabric
    'poplin'
    """
    return comparison_of(_simulate("compare", case, sheet, threads, progress))


def drape(
    case: CaseLike,
    sheet: Cloth | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Drape:
    """Hangs a round sheet over a disc, a case with ``kind = "drape"``: a minute or so for a fabric.

    The arguments are those of :func:`solve`.
    """
    return drape_of(_simulate("drape", case, sheet, threads, progress))


def run(
    inputs: Readable | Iterable[Readable],
    cases: Readable | Iterable[Readable] = (),
    out: Path | None = None,
    *,
    charts: bool = True,
    formats: Iterable[str] = ("png",),
    xlsx: bool = False,
    drape: bool | None = None,
    force: bool = False,
    stamp: str | None = None,
    solver: str | None = None,
    settings: Path | None = None,
    dialect: Path | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    assume_kes_units: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Run:
    """Does what ``kesf run`` does: every fabric and every case of the inputs, into a folder of results.

    Args:
        inputs: Fabrics: folders, files, bytes, or pairs of a name and bytes; they may hold cases too.
        cases: Cases, likewise.
        out: The folder; without one the files are in ``files`` of the result.
        charts: Whether charts are drawn.
        formats: What kinds of files charts become: ``png``, ``svg`` and ``pdf``.
        xlsx: Whether all tables are written into one workbook too, ``results.xlsx``.
        drape: Whether drape cases are solved, a minute or so for each fabric; when None, in runs of up to 20 fabrics a
            quick one of each fabric with measured curves, without friction.
        force: Whether files in the folder that kesf did not write are overwritten.
        stamp: Date and time for ``run.json``; without it the same input gives the same bytes.
        solver: ``auto``, ``direct`` or ``iterative``, whatever ``[solver]`` of the cases says.
        settings: TOML file with windows and thresholds of the evaluation.
        dialect, delimiter, decimal, assume_kes_units: As in :func:`read`.
        threads: Threads of the work; all of the machine when None. The results do not depend on it.
        progress: A bar such as ``tqdm.tqdm()``, or a function of what is done, steps done and steps in all.

    Raises:
        KesfError: if there is nothing to do, or the folder cannot be written. What fails of the inputs and tasks is in
            ``failures``.

    >>> import kesf
    >>> report = kesf.run("kesf_data/petrak_m1", "cases/virtual_bending.toml", charts=False)
    >>> report.fabrics, report.predictions["quantity"], "petrak_m1/section.json" in report.files
    (['petrak_m1'], ['B warp', 'B weft'], True)
    """
    paths, memory = sources(inputs)
    case_paths, case_memory = sources(cases)
    making = _Making(
        out=None if out is None else os.fspath(out),
        keep=True,
        charts=charts,
        formats=[formats] if isinstance(formats, str) else list(formats),
        xlsx=xlsx,
        drape=drape,
        stamp=stamp,
        force=force,
        solver=solver,
        settings=None if settings is None else os.fspath(settings),
    )
    options = _options(dialect, delimiter, decimal, assume_kes_units)
    memory = memory + case_memory
    raw = _kesf.run(paths + case_paths, memory, options, making, threads, follower(progress))
    parameters, predictions, problems, files, told, fails_a_check = raw
    return run_of((parameters, predictions, problems, told, fails_a_check), dict(files))


def verify(filter: str | None = None, *, threads: int | None = None, progress: Progress | None = None) -> Verification:
    """Solves problems with known answers, those whose id contains ``filter``, and compares.

    >>> import kesf
    >>> kesf.verify("patch.bending").passed
    True
    """
    return Verification(json.loads(_kesf.verify(filter, threads, follower(progress))))


def export(cloth: Cloth, to: str, path: Path | None = None, **assumptions: Any) -> Card:
    """A fabric as a material file of another program.

    Args:
        cloth: A section; or a sheet, fabric or path, with ``assumptions`` as in :func:`section`.
        to: The program; :func:`targets` has them all.
        path: Where the file is written, if it is to be.

    Raises:
        KesfError: if the program cannot hold this stiffness.

    >>> import kesf
    >>> card = kesf.export("kesf_data/poplin", to="u3m")
    >>> card.fabric, card.ending
    ('poplin', 'u3m')
    """
    if isinstance(cloth, Section):
        if assumptions:
            raise KesfError("a section has its assumptions", cure="leave the assumptions out, or export the sheet")
        made = cloth
    else:
        made = section(cloth, **assumptions)
    text, findings = _kesf.export(made._native, to)
    card = Card(made.name, to, targets()[to]["ending"], text, findings_of(findings))
    if path is not None:
        card.write(path)
    return card


def targets() -> dict[str, dict[str, str]]:
    """Programs that fabrics are exported to: ending of the files, what is written, and what it can hold.

    >>> import kesf
    >>> kesf.targets()["calculix"]["ending"]
    'calculix.inp'
    """
    return {name: {"ending": ending, "title": title, "holds": holds} for name, ending, title, holds in _kesf.targets()}


def explain(code: str) -> dict[str, str]:
    """What a code means: title, cause, example and cure.

    >>> import kesf
    >>> kesf.explain("R008")["kind"]
    'error'
    """
    text = _kesf.explain(code)
    if text is None:
        raise KesfError(f"`{code}` is no code", cure="codes are told with findings and failures")
    explained: dict[str, str] = json.loads(text)
    return explained
