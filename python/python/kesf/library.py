"""A library of fabrics that answers: which of them are like this one, and which are within these bounds.

A library is one Parquet file, a row a fabric: a column for each parameter in a direction in its customary KES unit
(``B_warp``, ``T0``, ``E_secant_weft``), with the unit in the metadata of the field, and ``thickness`` (mm) and
``mass`` (mg/cm²) beside ``T0`` and ``W``. Needs polars.

Likeness is the distance in the space of the sixteen KES parameters: each the mean over the directions that are known,
log10 for those that Kawabata takes logarithms of, less the mean over the library and over its standard deviation there;
the distance is the root mean square over the parameters that both fabrics have.
"""

from __future__ import annotations

import io
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _kesf, parts
from ._errors import KesfError
from ._evaluate import Evaluation
from ._fabrics import Fabric
from ._functions import characterise
from ._sheets import Sheet, Sheets
from ._types import Path

if TYPE_CHECKING:
    import polars

#: The parameters of a fabric's hand (Kawabata, The Standardization and Analysis of Hand Evaluation, 1980), and whether
#: their logarithm is taken.
SPACE = {
    "LT": False,
    "WT": True,
    "RT": False,
    "B": True,
    "2HB": True,
    "G": True,
    "2HG": True,
    "2HG5": True,
    "LC": False,
    "WC": True,
    "RC": False,
    "MIU": False,
    "MMD": True,
    "SMD": True,
    "T0": True,
    "W": True,
}

#: Names that people use, and what they stand for.
NAMES = {"thickness": "T0", "mass": "W"}

#: Fewest parameters that two fabrics must share to be compared.
FEWEST = 3


def _polars() -> Any:
    try:
        import polars
    except ImportError as error:
        raise KesfError("polars is not installed", code="O053", cure="pip install polars") from error
    return polars


def build(out: Path, *results: Path | Evaluation | Sheets) -> int:
    """Makes a library of results, and says how many fabrics it has.

    Args:
        out: The Parquet file.
        *results: Folders of :func:`kesf.dask.run` or parts of them, folders of ``kesf run``, evaluations, or sheets.

    Raises:
        KesfError: O059 for a folder that is none of these, O055 without a fabric, O056 if a fabric is in two of them,
            O001 if the file cannot be written.

    >>> import kesf, kesf.library, tempfile, os
    >>> folder = tempfile.mkdtemp()
    >>> kesf.library.build(os.path.join(folder, "library.parquet"), kesf.characterise(kesf.read("kesf_data")))
    13
    """
    pl = _polars()
    frames = [_tidy(pl, one).with_columns(source=pl.lit(str(number))) for number, one in enumerate(results)]
    if not frames or not sum(frame.height for frame in frames):
        raise KesfError("there is no fabric in the results", code="O055", cure="name folders of results")
    tidy = pl.concat(frames)
    twice = tidy.group_by("fabric").agg(pl.col("source").n_unique()).filter(pl.col("source") > 1).sort("fabric")
    if twice.height:
        name = twice["fabric"][0]
        raise KesfError(f"{name} is in two of the results", code="O056", cure="give each fabric a name of its own")
    wide = _wide(pl, tidy)
    _write(pl, wide, os.fspath(out), {row[0]: row[1] for row in tidy.select("name", "unit").unique().iter_rows()})
    return int(wide.height)


def _tidy(pl: Any, results: Path | Evaluation | Sheets) -> Any:
    """Fabric, name of the column, value and unit, in KES units."""
    if isinstance(results, (Evaluation, Sheets)):
        if isinstance(results, Evaluation):
            frame = pl.DataFrame(results).filter(pl.col("case").is_null())
            frame = frame.rename({"quantity": "parameter", "value": "mean"})
        else:
            frame = pl.DataFrame(results.parameters())
    else:
        frame = _stored(pl, os.fspath(results))
    named = pl.concat_str(
        [pl.col("parameter").str.replace(" ", "_"), pl.col("direction")], separator="_", ignore_nulls=True
    )
    frame = frame.filter(pl.col("mean").is_not_null())
    frame = frame.select("fabric", named.alias("name"), pl.col("mean").alias("value"), "unit")
    return _in_kes_units(pl, frame)


def _stored(pl: Any, path: str) -> Any:
    columns = ["fabric", "parameter", "direction", "mean", "unit"]
    table = os.path.join(path, "fabrics.csv")
    if os.path.exists(table):
        text = dict.fromkeys(("fabric", "parameter", "direction", "unit", "status"), pl.String)
        return pl.read_csv(table, schema_overrides=text).filter(pl.col("mean").is_not_null()).select(columns)
    parts = os.path.join(path, "part-*.parquet") if os.path.isdir(path) else path
    try:
        lazy = pl.scan_parquet(parts)
        lazy = lazy.filter(pl.col("case").is_null()).rename({"quantity": "parameter", "value": "mean"})
        return lazy.select(columns).collect()
    except (pl.exceptions.PolarsError, OSError) as error:
        raise KesfError(
            f"there are no results: {error}",
            code="O059",
            path=path,
            cure="name a folder that kesf.dask.run or `kesf run` wrote, or a part",
        ) from error


def _factors() -> dict[str, tuple[str, float]]:
    """Unit and SI value of the unit of every parameter, from the library's own tables."""
    return {symbol: (unit, factor) for symbol, unit, factor in _kesf.units_of_parameters()}


def _in_kes_units(pl: Any, frame: Any) -> Any:
    factors = _factors()
    symbol = pl.col("name").str.split("_").list.first()
    rows = [{"symbol": s, "kes": unit, "factor": factor} for s, (unit, factor) in factors.items()]
    table = pl.DataFrame(rows)
    joined = frame.with_columns(symbol=symbol).join(table, on="symbol", how="inner", maintain_order="left")
    return joined.select("fabric", "name", value=pl.col("value") / pl.col("factor"), unit=pl.col("kes"))


def _wide(pl: Any, tidy: Any) -> Any:
    wide = tidy.pivot(on="name", index="fabric", values="value", aggregate_function="first")
    extra = [pl.col(old).alias(new) for new, old in NAMES.items() if old in wide.columns]
    return wide.with_columns(extra).sort("fabric")


def _write(pl: Any, wide: Any, path: str, units: dict[str, str]) -> None:
    try:
        import pyarrow
    except ImportError as error:
        raise KesfError("pyarrow is not installed", code="O053", cure="pip install pyarrow") from error
    units = {**units, **{new: units[old] for new, old in NAMES.items() if old in units}}
    table = pyarrow.table(wide)
    fields = [
        field.with_metadata({"unit": units[field.name]}) if field.name in units else field for field in table.schema
    ]
    parts.write_file(path, parts.parquet(table.cast(pyarrow.schema(fields)), {"kesf.library": "1"}))


def find(
    library: Path,
    like: str | Sheet | Fabric | None = None,
    where: str | None = None,
    n: int = 10,
) -> polars.DataFrame:
    """Fabrics of a library within bounds, the most alike first.

    Args:
        library: A file that :func:`build` made.
        like: The name of a fabric of the library, which is left out of the answer; or a sheet, a fabric or the path of
            one.
        where: Bounds in SQL, in KES units: ``thickness < 0.4 and B_warp < 0.08``; names that begin with a figure stand
            in double quotes, ``"2HB_warp" < 0.05``.
        n: How many at most.

    Returns:
        A frame of polars: fabric, with ``like`` the ``distance`` (in standard deviations, root mean square) and how
        many ``parameters`` it rests on, and the columns of the library.

    Raises:
        KesfError: if the library cannot be read, the bounds cannot, or there is nothing to compare.
    """
    pl = _polars()
    path = os.fspath(library)
    try:
        lazy = pl.scan_parquet(path)
        columns = lazy.collect_schema().names()
    except (pl.exceptions.PolarsError, OSError) as error:
        raise KesfError(
            f"the library cannot be read: {error}", code="O042", path=path, cure="make it with kesf.library.build"
        ) from error
    wanted = lazy
    if where is not None:
        try:
            wanted = lazy.filter(pl.sql_expr(where))
            wanted.collect_schema()
        except (pl.exceptions.PolarsError, ValueError) as error:
            raise KesfError(
                f"the bounds cannot be used: {error}",
                cure=f"they are like `thickness < 0.4 and B_warp < 0.08`; there are {', '.join(columns[1:])}",
            ) from error
    if like is None:
        return wanted.head(n).collect()  # type: ignore[no-any-return]
    return _nearest(pl, lazy, wanted, like, path).head(n)  # type: ignore[no-any-return]


def _nearest(pl: Any, lazy: Any, wanted: Any, like: str | Sheet | Fabric, path: str) -> Any:
    space = _space(pl, lazy.collect_schema().names())
    if not space:
        raise KesfError("the library has no parameter to compare by", code="O055", path=path)
    population = lazy.select(fabric="fabric", **space).collect()
    own = population.filter(pl.col("fabric") == like) if isinstance(like, str) else None
    target, left_out = _target(pl, own, like)
    numbers = population.drop("fabric")
    means, deviations = numbers.mean().row(0, named=True), numbers.std().row(0, named=True)
    shared = [
        name
        for name in space
        if target.get(name) is not None and means[name] is not None and (deviations[name] or 0.0) > 0.0
    ]
    if len(shared) < FEWEST:
        raise KesfError(
            f"the fabric and the library share {len(shared)} parameters, and at least {FEWEST} are needed",
            code="O055",
            path=path,
        )
    squares = [((space[name] - target[name]) / deviations[name]) ** 2 for name in shared]
    count = pl.sum_horizontal([square.is_not_null().cast(pl.UInt32) for square in squares])
    distance = (pl.sum_horizontal(squares) / count).sqrt()
    answer = wanted.with_columns(distance=distance, parameters=count)
    answer = answer.filter((pl.col("parameters") >= FEWEST) & (pl.col("fabric") != left_out))
    columns = [name for name in wanted.collect_schema().names() if name != "fabric"]
    return answer.sort("distance", "fabric").select("fabric", "distance", "parameters", *columns).collect()


def _space(pl: Any, columns: Iterable[str]) -> dict[str, Any]:
    """The coordinates of fabrics in the space of the parameters."""
    names = list(columns)
    space = {}
    for symbol, logarithm in SPACE.items():
        known = [name for name in (f"{symbol}_warp", f"{symbol}_weft") if name in names]
        mean = pl.mean_horizontal([pl.col(name) for name in known]) if known else None
        whole = pl.col(symbol) if symbol in names else None
        if mean is None and whole is None:
            continue
        # The two directions where they are known, else the fabric as a whole.
        value: Any = whole if mean is None else mean if whole is None else pl.coalesce(mean, whole)
        # A value that is not above 0 has no logarithm and is not compared.
        space[symbol] = pl.when(value > 0.0).then(value.log10()) if logarithm else value
    return space


def _target(pl: Any, own: Any, like: str | Sheet | Fabric) -> tuple[dict[str, Any], str]:
    """Coordinates of the fabric, and the name that is left out of the answer."""
    if own is not None and own.height:
        return own.row(0, named=True), str(like)
    if isinstance(like, str) and not os.path.exists(like):
        raise KesfError(
            f"there is no fabric `{like}` in the library, and no file of that name",
            code="O055",
            cure="give the name of a fabric of the library, a sheet, or the path of a fabric",
        )
    sheet = like if isinstance(like, Sheet) else characterise(like)
    wide = _wide(pl, _tidy(pl, Sheets([sheet])))
    return wide.select(**_space(pl, wide.columns)).row(0, named=True), ""


def write_csv(frame: polars.DataFrame) -> str:
    """A frame as CSV."""
    sink = io.StringIO()
    frame.write_csv(sink)
    return sink.getvalue()
