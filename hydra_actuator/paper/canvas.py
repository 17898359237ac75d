# SPDX-License-Identifier: Apache-2.0
"""
What the figures share: quantities in the paper's units, second axes in SI, stations as ticks.

The paper's units are those of its equation (17): u/V_max, p/p_max (gauge), x/L and t c/L.
"""

from dataclasses import dataclass
import io

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.decimation import extreme_samples
from hydra_actuator.analysis.figure import MEGAPASCAL, MILLI
from hydra_actuator.analysis.palette import line_style, VELOCITY_STOPS
from hydra_actuator.analysis.picture import STYLE
from hydra_actuator.analysis.series import Field
from hydra_actuator.channels import STATIONS
from hydra_actuator.paper.runs import Run
import numpy as np

DOTS_PER_INCH = 110
LINE_POINTS = 3000          # buckets of a long line, each with its lowest and highest value
TAU_LABEL, X_LABEL = 'time t c/L [-]', 'streamline x/L [-]'
LEGEND = {'frameon': False, 'fontsize': 8, 'handlelength': 2.6}
QUIET = '#59636e'
SMALL = 1e-3                # of a unit: below, SI is told a million times finer


@dataclass(frozen=True)
class Quantity:
    """Velocity or pressure: labels, and how the run gives it in the paper's units."""

    name: str
    symbol: str
    si_label: str
    velocity: bool

    @property
    def label(self) -> str:
        """What stands on an axis."""
        return f'{self.name} {self.symbol} [-]'

    def si_unit(self, run: Run) -> float:
        """Return one unit in m/s or MPa."""
        return run.velocity_unit if self.velocity else run.pressure_unit * MEGAPASCAL

    def stations(self, run: Run) -> np.ndarray:
        """Return the quantity at the stations at every step, (T, 12)."""
        return run.station_velocity if self.velocity else run.station_pressure

    def field(self, run: Run, field: Field) -> np.ndarray:
        """Return the quantity at all nodes in all frames of a field; NaN behind the piston."""
        if self.velocity:
            return field.velocity / run.velocity_unit
        return run.to_units_of_pressure(field.pressure)

    def small_unit(self, run: Run, largest: float) -> tuple[float, str]:
        """Return one unit in SI and its label, for changes no larger than `largest` units."""
        if largest > SMALL:
            return self.si_unit(run), self.si_label
        return self.si_unit(run) * 1e6, 'um/s' if self.velocity else 'Pa'

    def unit_in_words(self, run: Run) -> str:
        """Return what 1 is, for a caption."""
        symbol = 'V_max' if self.velocity else 'p_max'
        return f'1 is {symbol} = {self.si_unit(run):.4g} {self.si_label}'


VELOCITY = Quantity('velocity', 'u/V_max', 'm/s', True)
PRESSURE = Quantity('pressure', 'p/p_max', 'MPa', False)


def new_figure(size: tuple[float, float]):
    """Return an empty matplotlib figure of a size [inch]; none of pyplot's state is touched."""
    from matplotlib.figure import Figure
    return Figure(figsize=size, facecolor='white', layout='constrained')


def draw_styled(draw, *arguments):
    """Return what a drawing function returns, called under the house's style."""
    from matplotlib import rc_context
    with rc_context(STYLE):
        return draw(*arguments)


def png(figure) -> bytes:
    """Return a figure as a PNG."""
    buffer = io.BytesIO()
    draw_styled(lambda: figure.savefig(buffer, dpi=DOTS_PER_INCH, format='png'))
    return buffer.getvalue()


def velocity_colours():
    """Return the colour map of what has a sign."""
    from matplotlib.colors import LinearSegmentedColormap
    return LinearSegmentedColormap.from_list('velocity', VELOCITY_STOPS)


def si_right(axes, unit: float, label: str):
    """Add an axis at the right in SI: one unit of the left one is `unit` there."""
    axis = axes.secondary_yaxis('right', functions=(lambda y: y * unit, lambda y: y / unit))
    axis.set_ylabel(label)
    return axis


def si_top(axes, run: Run):
    """Add an axis at the top with the time in milliseconds."""
    unit = run.time_unit * MILLI
    axis = axes.secondary_xaxis('top', functions=(lambda t: t * unit, lambda t: t / unit))
    axis.set_xlabel('time [ms]')
    return axis


def station_ticks(axes, run: Run) -> None:
    """Label x/L by the fixed stations and their place, the ends of the domains."""
    ends = streamline.boundaries(run.field)
    unit = run.length_unit
    axes.set_xticks([x / unit for x, _ in ends],
                    [f'{letters}\n{x / unit:.3g}' for x, letters in ends])
    axes.set(xlabel=X_LABEL, xlim=(0.0, ends[-1][0] / unit))


def station_line(letter: str) -> dict:
    """Return colour and dash of a station as matplotlib takes them; ends of a domain share one."""
    style = line_style(letter, STATIONS.index(letter))
    return {'color': style['color'], 'linestyle': '--' if style['dash'] == 'dash' else '-'}


def plot_line(axes, x: np.ndarray, y: np.ndarray, **style):
    """Draw a line of any length: of each bucket of samples its lowest and highest."""
    kept = extreme_samples(y, LINE_POINTS)
    return axes.plot(x[kept], y[kept], **style)[0]


def mark_vacuum(axes, run: Run) -> None:
    """Draw where the absolute pressure is zero, below which the plain model is no oil."""
    vacuum = run.to_units_of_pressure(np.zeros(1))[0]
    axes.axhline(vacuum, color=QUIET, linewidth=0.8, linestyle=':')
    axes.annotate('vacuum', (1.0, vacuum), xycoords=('axes fraction', 'data'), fontsize=7,
                  color=QUIET, ha='right', va='top', xytext=(-2, -2),
                  textcoords='offset points')


def about_cavities(case) -> str:
    """Return what to say of a difference between two runs with cavitation, else nothing."""
    if not case.cavitation:
        return ''
    return (' With cavities the two runs part: a collapse that comes a little earlier in one is a '
            'whole pressure peak of difference, and moves the next collapse further.')


def extreme_words(values: np.ndarray, tau: np.ndarray, unit: str) -> str:
    """Return lowest and highest of (T, 12) values at the stations, where and when, in words."""
    words = []
    for name, find in (('Lowest', np.argmin), ('highest', np.argmax)):
        k, station = np.unravel_index(find(values), values.shape)
        words.append(f'{name} {values[k, station]:.4g} {unit} at {STATIONS[station]}, '
                     f'{tau[k]:.4g} units')
    return '; '.join(words)
