"""A library of fabrics that answers: which of them are like this one, and which are within these bounds.

A library is one Parquet file, a row a fabric: a column for each parameter in a direction in its customary KES unit
(``B_warp``, ``T0``, ``E_secant_weft``), with the unit in the metadata of the field, and ``thickness`` (mm) and
``mass`` (mg/cm²) beside ``T0`` and ``W``; beside each of them, in ``B_warp_status``, is how the value was had:
``measured``, ``inferred``, ``assumed`` or ``doubtful``. ``kesf library`` makes and asks the same file. Answers need
polars.

Likeness is the distance in the space of the sixteen KES parameters: each the mean of warp and weft, or the one
direction that both fabrics have if one of them lacks the other, log10 for those that Kawabata takes logarithms of, in
standard deviations of the library; the distance is the root mean square over the parameters in which the two can be
compared.
"""

from __future__ import annotations

import io
import os
import warnings
from typing import TYPE_CHECKING, Any

from . import _kesf, parts
from ._errors import KesfError, KesfWarning
from ._evaluate import Evaluation
from ._fabrics import Fabric
from ._functions import _outside, characterise
from ._sheets import Sheet, Sheets
from ._table import Table
from ._types import Path

if TYPE_CHECKING:
    import polars


def _polars() -> Any:
    try:
        import polars
    except ImportError as error:
        raise KesfError("polars is not installed", code="O053", cure="pip install polars") from error
    return polars


def build(out: Path, *results: Path | Evaluation | Sheets) -> int:
    """Makes a library of results, and says how many fabrics it has.

    Fabrics of the results of which no value is known are left out with a :class:`kesf.KesfWarning`.

    Args:
        out: The Parquet file.
        *results: Folders of :func:`kesf.dask.run` or parts of them, folders of ``kesf run``, evaluations, or sheets.

    Raises:
        KesfError: O069 for what is none of these or has no fabric, O068 if a fabric is in two of them, O001 if the file
            cannot be written, O007 for a folder whose run was broken off or is still going on.

    >>> import kesf, kesf.library, tempfile, os
    >>> folder = tempfile.mkdtemp()
    >>> kesf.library.build(os.path.join(folder, "library.parquet"), kesf.characterise(kesf.read("kesf_data")))
    13
    """
    given: list[str | tuple[str, _kesf.Table]] = []
    for number, one in enumerate(results, 1):
        if isinstance(one, Evaluation):
            given.append((f"evaluation {number}", one.results._native))
        elif isinstance(one, Sheets):
            given.append((f"sheets {number}", one.parameters()._native))
        else:
            given.append(os.fspath(one))
    data, count, left_out = _kesf.library_build(given)
    parts.write_file(os.fspath(out), data)
    if left_out:
        text = f"fabrics without KES values are left out: {', '.join(left_out)}"
        warnings.warn(text, KesfWarning, stacklevel=_outside())
    return count


def find(
    library: Path,
    like: str | Sheet | Fabric | None = None,
    where: str | None = None,
    n: int | None = None,
) -> polars.DataFrame:
    """Fabrics of a library within bounds, the most alike first.

    Args:
        library: A file that :func:`build` made.
        like: The name of a fabric of the library, which is left out of the answer; or a sheet, a fabric or the path of
            one.
        where: Bounds in SQL, in KES units: ``thickness < 0.4 and 2HB_warp between 0.02 and 0.05``.
            Comparisons, between, in, is null, and, or, not and arithmetic are understood.
        n: How many at most; if not given, ten with ``like``, and without it all that are within the bounds.

    Returns:
        A frame of polars: fabric, with ``like`` the ``distance`` (in standard deviations, root mean square), how many
        ``parameters`` it rests on, what the two were ``not_compared`` in and which of the values it rests on are
        ``doubtful``, and the columns of the library.

    Warns:
        KesfWarning: What speaks against the answer: values of ``like`` that are not plainly measured, fabrics that have
            no value in a column of the bounds, a text that no fabric has, or fabrics that share too few parameters
            with ``like`` to be compared.

    Raises:
        KesfError: O070 if the library cannot be read or an earlier version made it, O071 if the bounds cannot, and O072
            if there is nothing to compare with.
    """
    pl, path = _polars(), os.fspath(library)
    name = like if isinstance(like, str) else None
    table = None if like is None or name is not None else _parameters(like)
    found = _kesf.library_find(path, name, table, where, n)
    if found is None and name is not None and os.path.exists(name):
        found = _kesf.library_find(path, None, _parameters(name), where, n)
    if found is None:
        raise KesfError(
            f"there is no fabric `{name}` in the library, and no file of that name",
            code="O072",
            cure="give the name of a fabric of the library, a sheet, or the path of a fabric",
        )
    answer, said = found
    for text in said:
        warnings.warn(text, KesfWarning, stacklevel=_outside())
    return pl.DataFrame(Table(answer))  # type: ignore[no-any-return]


def _parameters(like: str | Sheet | Fabric) -> _kesf.Table:
    sheet = like if isinstance(like, Sheet) else characterise(like)
    return Sheets([sheet]).parameters()._native


def write_csv(frame: polars.DataFrame) -> str:
    """A frame as CSV."""
    sink = io.StringIO()
    frame.write_csv(sink)
    return sink.getvalue()
