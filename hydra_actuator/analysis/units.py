# SPDX-License-Identifier: Apache-2.0
"""
In what units a picture shows a run: SI with the pressure in Pa, bar or MPa, or the paper's.

The paper's are those of its equation (17): u/V_max, x/L, p/p_max (gauge) and t c/L, with V_max =
max_flow over the area of the supply line, p_max = supply pressure, L = the whole streamline and c
the speed of waves in the oil alone.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
import math

from hydra_actuator.analysis.series import Series
from hydra_actuator.errors import InputError
from hydra_actuator.parameters import definitions
from hydra_actuator.parameters.streamline import streamline_length, wave_speed
import numpy as np

PRESSURE_UNITS = {'Pa': 1.0, 'bar': 1e-5, 'MPa': 1e-6}
STANDARD_PRESSURE = 101325.0


@dataclass(frozen=True)
class Scale:
    """How a quantity is shown: (SI value - zero) x factor, in a unit or as a ratio (symbol)."""

    factor: float
    unit: str
    symbol: str = ''
    zero: float = 0.0

    def __call__(self, values) -> np.ndarray:
        """Return SI values as they are shown."""
        return (np.asarray(values) - self.zero) * self.factor

    def label(self, name: str) -> str:
        """Return what stands on an axis: `time [s]`, or `time t c/L [-]`."""
        return f'{name} {self.symbol} [-]' if self.symbol else f'{name} [{self.unit}]'


@dataclass(frozen=True)
class Units:
    """The scales of a picture; `travel` is that of the piston's position."""

    pressure: Scale = Scale(1e-6, 'MPa abs')
    velocity: Scale = Scale(1.0, 'm/s')
    place: Scale = Scale(1.0, 'm')
    travel: Scale = Scale(1e3, 'mm')
    time: Scale = Scale(1.0, 's')
    frequency: Scale = Scale(1.0, 'Hz')

    def since(self, start: float) -> tuple[Scale, str]:
        """Return scale and axis label of times in a short window: ms from start [s], or t c/L."""
        if self.time.symbol:
            return self.time, self.time.label('time')
        name = f'time after {start:.4g} s' if start else 'time'
        return Scale(1e3, 'ms', zero=start), f'{name} [ms]'

    @property
    def pressure_change(self) -> Scale:
        """The scale of a difference of pressures, which has no zero."""
        return replace(self.pressure, zero=0.0, unit=self.pressure.unit.removesuffix(' abs'))


SI = Units()


def units_named(pressure: str) -> Units:
    """Return SI units with the pressure in 'Pa', 'bar' or 'MPa', absolute."""
    return Units(pressure=Scale(PRESSURE_UNITS[pressure], f'{pressure} abs'))


def nondimensional(series: Series) -> Units:
    """Return the paper's units for a run; InputError where it lacks what they are made of."""
    if not series.parameters:
        raise InputError(f'{series.name} holds no parameters, of which the non-dimensional form '
                         'is made')
    values = complete(series)
    flow, supply = values['supply.max_flow'], values['supply.pressure']
    if flow <= 0.0 or supply <= 0.0:
        raise InputError(f'{series.name}: the non-dimensional form needs supply.max_flow and '
                         f'supply.pressure above 0, not {flow:g} and {supply:g}')
    length = streamline_length(values)
    velocity = flow / (0.25 * math.pi * values['supply_line.diameter']**2)
    rate = wave_speed(values) / length
    return Units(
        Scale(1.0 / supply, '', 'p/p_max', values['ambient_pressure']),
        Scale(1.0 / velocity, '', 'u/V_max'), Scale(1.0 / length, '', 'x/L'),
        Scale(1.0 / length, '', 'x/L'), Scale(rate, '', 't c/L'),
        Scale(1.0 / rate, '', 'f L/c'))


def choices(series: Series) -> dict[str, Units]:
    """Return all units that a run can be shown in, by what they are called."""
    found = {name: units_named(name) for name in ('MPa', 'bar', 'Pa')}
    try:
        return {**found, 'non-dimensional': nondimensional(series)}
    except InputError:
        return found


def complete(series: Series) -> Mapping[str, object]:
    """Return every parameter of a run, defaults for what its recording does not name."""
    table = definitions(series.section_names)
    return {**{name: one.default for name, one in table.items()}, **series.parameters}
