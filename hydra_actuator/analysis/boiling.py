# SPDX-License-Identifier: Apache-2.0
"""
Where the oil boiled, and where a model without cavitation let it fall below vacuum.

The void fraction of a place follows from its absolute pressure p, gas at constant heat:

    alpha = air_fraction (ambient - p_v) / (p - p_v)

Neglected, as in the solver: growth of bubbles, solution and release of gas.
"""

from typing import NamedTuple

from hydra_actuator.analysis.series import Series
import numpy as np

# Rounding leaves this much [Pa] about a vacuum.
MARGIN = 1.0
# Least absolute less vapour pressure [Pa] that single precision tells from none.
LEAST = 1e-3


class Lowest(NamedTuple):
    """The lowest absolute pressure [Pa] of a run, when [s], and where in words."""

    pressure: float
    time: float
    place: str


def cavitation_was_on(series: Series) -> bool:
    """Tell whether the run modelled free gas and vapour."""
    return bool(series.parameters.get('fluid.cavitation', False))


def void_fraction(series: Series, pressure: np.ndarray) -> np.ndarray:
    """Return the gas by volume at absolute pressures [Pa] of a run with cavitation."""
    p = series.parameters
    vapour = p.get('fluid.vapour_pressure', 0.0)
    held = p.get('fluid.air_fraction', 0.0) * (p.get('ambient_pressure', 101325.0) - vapour)
    return held / np.maximum(np.asarray(pressure, float) - vapour, LEAST)


def lowest_pressure(series: Series) -> Lowest | None:
    """Return the lowest pressure of all sections and of the field; None without either."""
    found = []
    in_sections = series.extreme_pressure('lowest')
    if in_sections:
        pressure, tick, k = in_sections
        found.append(Lowest(pressure, float(series.time[tick]), f'at {series.section_names[k]}'))
    field = series.field
    in_field = field and field.lowest_pressure()
    if in_field:
        pressure, frame, node = in_field
        found.append(Lowest(pressure, float(field.time[frame]),
                            f'in {field.labels[node]}, x = {field.positions[node]:.3g} m'))
    return min(found, default=None)


def warnings(series: Series) -> list[str]:
    """Return what the reader of a run must know about pressures that no oil can have."""
    lowest = lowest_pressure(series)
    if cavitation_was_on(series) or lowest is None or lowest.pressure >= -MARGIN:
        return []
    return [f'The plain model let the absolute pressure fall to {lowest.pressure * 1e-6:.3g} MPa '
            f'{lowest.place}, t = {lowest.time:.4f} s, below vacuum: turn fluid.cavitation on.']
