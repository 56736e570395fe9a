"""Figures with matplotlib, from the data of the PNG charts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import KesfError
from ._sheets import Sheet
from ._types import Floats, Test

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Okabe & Ito (2008), as in the PNG charts: warp, weft, bias; warp's where there is no direction.
COLOURS = {"warp": "#0072b2", "weft": "#d55e00", "bias": "#009e73", None: "#0072b2"}
DASHES: dict[str | None, Any] = {"warp": "-", "weft": (0, (5, 2)), "bias": (0, (1.5, 1.5)), None: "-"}

#: Axes of the tests.
AXES = {
    "tensile": ("Strain", "Force per width"),
    "shear": ("Shear angle", "Shear force per width"),
    "bending": ("Curvature", "Moment per width"),
    "compression": ("Thickness", "Pressure"),
    "friction": ("Position", "Coefficient of friction"),
    "roughness": ("Position", "Height of the surface"),
}

#: The parameter whose middle specimen is drawn in full strength.
LEADING = {"tensile": "WT", "shear": "G", "bending": "B", "compression": "WC", "friction": "MIU", "roughness": "SMD"}


def plot(sheet: Sheet, test: Test = "bending", axes: Axes | None = None) -> Figure:
    """The loops of all specimens in KES units, the one nearest to the mean in full strength with the lines that its
    parameters are read from, and the 95 % band of the mean.

    Args:
        sheet: The sheet of a fabric with curves.
        test: ``tensile``, ``shear``, ``bending``, ``compression``, ``friction`` or ``roughness``.
        axes: Where to draw; a figure of its own when None.

    Raises:
        KesfError: if matplotlib is not installed, or no curve of the test was recorded.
    """
    data = sheet.curves(test)
    if not data["specimens"]:
        raise KesfError(
            f"{sheet.name} has no recorded curve of the {test} test",
            code="O055",
            cure="sheet.chart(test) draws the PNG chart of published values where there are enough of them",
        )
    if axes is None:
        axes = _new_axes()
    x_factor, y_factor = data["factors"]
    _bands(axes, data, x_factor, y_factor)
    strong = {id(specimen) for specimen in _nearest(sheet, test, data["specimens"])}
    labelled: set[str | None] = set()
    for specimen in sorted(data["specimens"], key=lambda s: id(s) in strong):
        _specimen(axes, specimen, (x_factor, y_factor), id(specimen) in strong, labelled)
    x_name, y_name = AXES[test]
    x_unit, y_unit = data["units"]
    axes.set_xlabel(f"{x_name} ({x_unit})")
    axes.set_ylabel(f"{y_name} ({y_unit})")
    axes.set_title(f"{sheet.title or sheet.name}, {test} ({sheet.origin} data)")
    axes.grid(visible=True, color="#e3e3e3", linewidth=0.6)
    axes.set_axisbelow(True)
    if labelled - {None}:
        axes.legend(frameon=False)
    figure = axes.get_figure(root=True)
    assert figure is not None
    return figure


def _new_axes() -> Axes:
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise KesfError(
            "matplotlib is not installed", code="O055", cure="pip install matplotlib, or take sheet.chart(test)"
        ) from error
    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    return figure.add_subplot()


def _nearest(sheet: Sheet, test: Test, specimens: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The specimen of each direction that is nearest to the mean."""
    found = []
    for direction in dict.fromkeys(s["direction"] for s in specimens):
        estimate = sheet.get(LEADING[test], direction)
        mean = None if estimate is None else estimate.mean

        def distance(specimen: dict[str, Any], mean: float | None = mean) -> float:
            value = specimen["values"].get(LEADING[test])
            return float("inf") if mean is None or value is None else abs(value - mean)

        found.append(min((s for s in specimens if s["direction"] == direction), key=distance))
    return found


def _curve(curve: dict[str, list[float]], factors: tuple[float, float]) -> tuple[Floats, Floats]:
    x = np.array(curve["x"], dtype=np.float64) / factors[0]
    y = np.array(curve["y"], dtype=np.float64) / factors[1]
    return x, y


def _specimen(
    axes: Axes,
    specimen: dict[str, Any],
    factors: tuple[float, float],
    strong: bool,
    labelled: set[str | None],
) -> None:
    direction = specimen["direction"]
    style: dict[str, Any] = {"color": COLOURS[direction], "linestyle": DASHES[direction]}
    style.update({"linewidth": 1.8} if strong else {"linewidth": 0.8, "alpha": 0.45})
    for branch in specimen["branches"]:
        label = None
        if strong and direction not in labelled:
            label = direction
            labelled.add(direction)
        axes.plot(*_curve(branch["curve"], factors), label=label, **style)
    if strong:
        for window in specimen["windows"]:
            x, y = [window["from"], window["to"]], window["ordinates"]
            line = _curve({"x": x, "y": y}, factors)
            axes.plot(*line, color="#1a1a1a", linewidth=1.2, solid_capstyle="butt")


def _bands(axes: Axes, data: dict[str, Any], x_factor: float, y_factor: float) -> None:
    """The 95 % band of the mean, between its two edges."""
    for branch in data["mean"]:
        low, high = (_curve(branch[edge], (x_factor, y_factor)) for edge in ("low", "high"))
        x = np.concatenate([low[0], high[0][::-1]])
        y = np.concatenate([low[1], high[1][::-1]])
        axes.fill(x, y, color=COLOURS[branch["direction"]], alpha=0.15, linewidth=0.0)
