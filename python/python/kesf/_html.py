"""Small tables and pictures for notebooks: HTML and SVG as text, nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

from ._errors import Finding
from ._types import Floats

_STYLE = "border-collapse:collapse;font-size:90%"
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")


def number(value: object, digits: int = 4) -> str:
    """A number with significant digits; text as it is; nothing for None.

    >>> number(0.000123456), number(None), number("warp"), number(12)
    ('0.0001235', '', 'warp', '12')
    """
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    return str(value)


def table(header: Sequence[str], rows: Iterable[Sequence[object]], caption: str = "", most: int = 20) -> str:
    """An HTML table; of more than ``most`` rows the first ones and how many are left out."""
    rows = list(rows)
    head = "".join(f"<th style='text-align:left'>{escape(name)}</th>" for name in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(number(cell))}</td>" for cell in row) + "</tr>" for row in rows[:most]
    )
    left = len(rows) - most
    more = f"<tr><td colspan='{len(header)}'>… {left} more</td></tr>" if left > 0 else ""
    title = f"<caption style='text-align:left'><b>{escape(caption)}</b></caption>" if caption else ""
    return f"<table style='{_STYLE}'>{title}<tr>{head}</tr>{body}{more}</table>"


def findings(told: Sequence[Finding], most: int = 5) -> str:
    """A list of findings, each as its code and sentence; nothing for none."""
    items = [f"<li>{escape(f'{finding.code} {finding.message}')}</li>" for finding in told[:most]]
    if len(told) > most:
        items.append(f"<li>… {len(told) - most} more</li>")
    return f"<ul>{''.join(items)}</ul>" if items else ""


def lines(
    curves: Sequence[tuple[Floats, Floats]], width: int = 220, height: int = 60, colours: Sequence[str] = _COLOURS
) -> str:
    """Curves in one small SVG picture, each over the same axes; nothing without a point."""
    drawn = [(np.asarray(x, float), np.asarray(y, float)) for x, y in curves]
    drawn = [(x, y) for x, y in drawn if len(x) > 1 and np.isfinite(x).all() and np.isfinite(y).all()]
    if not drawn:
        return ""
    low_x, high_x = min(x.min() for x, _ in drawn), max(x.max() for x, _ in drawn)
    low_y, high_y = min(y.min() for _, y in drawn), max(y.max() for _, y in drawn)
    across, up = (high_x - low_x) or 1.0, (high_y - low_y) or 1.0
    paths = []
    for k, (x, y) in enumerate(drawn):
        step = max(1, len(x) // 200)
        u = 2 + (x[::step] - low_x) / across * (width - 4)
        v = height - 2 - (y[::step] - low_y) / up * (height - 4)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(u, v, strict=True))
        colour = colours[k % len(colours)]
        paths.append(f"<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='1'/>")
    return (
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' role='img'>"
        + "".join(paths)
        + "</svg>"
    )
