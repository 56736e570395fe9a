"""Tables that every program of data frames takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import _kesf
from ._html import table as html_table


class Table:
    """A table whose columns are text, 64-bit numbers or counts; what is absent is null.

    It has the PyCapsule interface of Arrow, so that ``polars.DataFrame(table)``, ``pyarrow.table(table)``,
    ``pandas.DataFrame.from_arrow(table)`` and ``duckdb.sql("from table")`` take it without a copy. The metadata of a
    field says its unit: ``unit``, and where one column holds several units ``unit_column``, the column that has
    them.

    >>> import kesf
    >>> sheet = kesf.characterise("kesf_data/petrak_m1")
    >>> table = sheet.parameters()
    >>> table.column_names[:4], len(table), table["parameter"][-1]
    (['fabric', 'parameter', 'direction', 'mean'], 10, 'drape_coefficient')
    >>> table.units["cv"]
    '1'
    """

    __slots__ = ("_native",)

    def __init__(self, native: _kesf.Table) -> None:
        self._native = native

    def __arrow_c_schema__(self) -> object:
        """The schema, as a capsule."""
        return self._native.__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The table, as a capsule; a requested schema is not looked at, as the interface allows."""
        return self._native.__arrow_c_stream__(requested_schema)

    @property
    def column_names(self) -> list[str]:
        """Names of the columns, in order."""
        return self._native.column_names

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column that has the same one throughout."""
        return self._native.units

    def to_pydict(self) -> dict[str, list[Any]]:
        """Columns as lists, by name."""
        return self._native.to_pydict()

    def rows(self) -> list[dict[str, Any]]:
        """Rows as dictionaries."""
        columns = self.to_pydict()
        return [dict(zip(columns, cells, strict=True)) for cells in zip(*columns.values(), strict=False)]

    def __getitem__(self, name: str) -> list[Any]:
        """The cells of a column."""
        return self._native[name]

    def __len__(self) -> int:
        return len(self._native)

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, Table) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return Table, (self._native,)

    def _cells(self) -> Sequence[Sequence[object]]:
        return list(zip(*self.to_pydict().values(), strict=True))

    def __repr__(self) -> str:
        return f"<kesf.Table: {len(self)} rows, columns {', '.join(self.column_names)}>"

    def _repr_html_(self) -> str:
        return html_table(self.column_names, self._cells())


def predictions_html(
    predictions: Table, caption: str = "", columns: Sequence[str] = ("quantity", "simulated", "measured", "unit")
) -> str:
    """Rows of ``predictions.csv`` with where they come from and what speaks against them."""
    header = (*columns, "origin", "inputs", "status", "remark")
    return html_table(header, [[row[name] for name in header] for row in predictions.rows()], caption)
