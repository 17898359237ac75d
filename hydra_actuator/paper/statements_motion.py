# SPDX-License-Identifier: Apache-2.0
"""Statements on the motion: where the run ends, the strokes, the mesh, flow that turns back."""

import math
from typing import NamedTuple

from hydra_actuator.paper.drawing import BLUE, GREY, ORANGE, panels, SKY, VERMILION
from hydra_actuator.paper.drive import (
    drive,
    field_at,
    FREQUENCY,
    PERIOD,
    reference,
    SECOND,
    sine,
    STEPS_BETWEEN,
    Trace,
    unit_time,
)
from hydra_actuator.paper.statement import Finding, Statement
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

AT_NULL = 640.0         # sixteen whole periods, the last null of the valve within the second
SMALL = 0.02            # of the largest: what counts as degenerated, negligible, symmetric
LITTLE = 0.1            # of the largest forward flow: what counts as very small
STEADY = 10 * PERIOD    # when the start is forgotten
FAST = (20 * PERIOD * FREQUENCY / 50.0, 50.0, 1.0, 5)   # twenty periods of 50 Hz
FASTER = (20 * PERIOD * FREQUENCY / 200.0, 200.0, 0.3, 2)
MILLI, MEGA = 1e3, 1e-6
UNITS = 'time [L/c]'


def largest_velocity_at(units: float) -> float:
    """Return the largest |u| [m/s] of the field at a time in units of L/c."""
    return float(np.abs(field_at(sine(FREQUENCY), units)[2]).max())


def final_velocity() -> Statement:
    """Judge whether the velocity vanishes at the end of the run."""
    at_null, at_end = (largest_velocity_at(units) for units in (AT_NULL, SECOND))
    vanishes = [velocity < SMALL * at_end for velocity in (at_null, at_end)]
    return Statement(
        'final_velocity',
        'At the final moment the velocity practically degenerates to zero everywhere.',
        'section 7, figure 3e', True if all(vanishes) else None if any(vanishes) else False,
        'It does where the valve is shut, at whole periods. One second is 16.25 periods: then '
        'the sine has the valve fully open and the oil at its fastest.',
        (Finding(f'largest velocity at {AT_NULL:g} units, valve shut', 'm/s', '0',
                 f'{at_null:.3f}'),
         Finding(f'largest velocity at {SECOND:g} units, valve fully open', 'm/s', '0',
                 f'{at_end:.2f}')),
        draw_final)


def draw_final(figure) -> None:
    """Draw velocity and pressure along the streamline at the last null and at the last moment."""
    left, right = panels(figure, ('streamline, pump to tank [m]', 'velocity [m/s]'),
                         ('streamline, pump to tank [m]', 'pressure [MPa gauge]'))
    for units, colour in ((AT_NULL, BLUE), (SECOND, VERMILION)):
        x, pressure, velocity = field_at(sine(FREQUENCY), units)
        left.plot(x, velocity, color=colour, label=f'{units:g} L/c')
        right.plot(x, pressure * MEGA, color=colour)
    left.legend(frameon=False)


class Strokes(NamedTuple):
    """Lowest and highest position [m] of each whole period, each (N,)."""

    lowest: np.ndarray
    highest: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        """Middle of the stroke [m]."""
        return 0.5 * (self.lowest + self.highest)


def strokes(trace: Trace, period: float = PERIOD) -> Strokes:
    """Return the strokes of all whole periods, a period in units of L/c."""
    count = math.floor(trace.units[-1] / period + 1e-3)
    parts = [trace.position[(trace.units >= k * period) & (trace.units <= (k + 1) * period)]
             for k in range(count)]
    return Strokes(np.array([part.min() for part in parts]),
                   np.array([part.max() for part in parts]))


def start_phase(phase: float) -> Trace:
    """Return five periods of the paper's case whose sine begins at a phase [periods]."""
    p = paper_parameters()

    def command(times: np.ndarray) -> np.ndarray:
        return np.sin(2.0 * math.pi * (FREQUENCY * times + phase))

    return drive(p, command, 5 * PERIOD * unit_time(p), STEPS_BETWEEN)


def unequal_strokes() -> Statement:
    """Judge what makes the piston's motion lie off its middle."""
    found, cosine = strokes(reference()), strokes(start_phase(0.25))
    middle = found.middle
    rate = math.log(middle[4] / middle[-1]) / (len(middle) - 5)
    last = abs(middle[-1]) / (found.highest[-1] - found.lowest[-1])
    fades = last < SMALL
    return Statement(
        'unequal_strokes',
        'Direct and reverse operation make the motion of the piston asymmetric, about a position '
        'other than zero.',
        'section 7, figure 3c', None if fades and middle[0] > 0.0 else not fades,
        f'Asymmetric it is at first, by the phase in which the sine starts; that fades by '
        f'{100 * (1 - math.exp(-rate)):.0f} % per period and is {100 * last:.1f} % of the stroke '
        'in the last. Direct and reverse operation as such are equal: a cosine starts off the '
        'middle by far less.',
        (Finding('first period', 'mm', 'asymmetric',
                 f'{found.lowest[0] * MILLI:.1f} to {found.highest[0] * MILLI:+.1f}'),
         Finding(f'period {len(middle)}, the last', 'mm', 'asymmetric',
                 f'{found.lowest[-1] * MILLI:.1f} to {found.highest[-1] * MILLI:+.1f}'),
         Finding('middle of the stroke, first and last period', 'mm', 'not 0',
                 f'{middle[0] * MILLI:.2f} and {middle[-1] * MILLI:.3f}'),
         Finding('middle of the stroke, first period of a cosine', 'mm', '-',
                 f'{cosine.middle[0] * MILLI:.2f}')),
        draw_strokes)


def draw_strokes(figure) -> None:
    """Draw the piston over the run, and the middle of each stroke."""
    trace, found = reference(), strokes(reference())
    left, right = panels(figure, (UNITS, 'piston [mm]'),
                         ('period', 'middle of the stroke [mm]'))
    left.plot(trace.units, trace.position * MILLI, color=BLUE, linewidth=0.9)
    left.axhline(0.0, color=GREY, linewidth=0.8)
    right.semilogy(np.arange(1, len(found.middle) + 1), found.middle * MILLI, 'o-', color=BLUE)


def equal_velocities() -> Statement:
    """Judge whether direct and reverse operation give velocities of the same order."""
    trace = reference()
    late = trace.units > STEADY
    rows = []
    for station in 'BEI':
        velocity = trace.velocity(station)[late]
        rows.append((station, float(velocity.max()), float(-velocity.min())))
    return Statement(
        'equal_velocities',
        'Between the edges of the valve, velocities are of the same order of magnitude in direct '
        'and reverse operation.',
        'section 7, figure 2c', all(0.5 < a / b < 2.0 for _, a, b in rows),
        'Once the start is forgotten they are equal within '
        f'{100 * max(abs(a / b - 1.0) for _, a, b in rows):.1f} %.',
        tuple(Finding(f'largest velocity at {station}, direct and reverse', 'm/s', 'same order',
                      f'{a:.3f} and {b:.3f}') for station, a, b in rows))


def mesh_deflection() -> Statement:
    """Judge how far velocities bend the characteristics."""
    trace = reference()
    largest = float(trace.mach.max())
    return Statement(
        'mesh_deflection',
        'The net of characteristics is practically not deflected by the motion of the oil and of '
        'the piston.',
        'section 7, figures 4a and 4b', largest < SMALL,
        'A characteristic has the slope u + c or u - c; u/c is its deflection.',
        (Finding('largest u/c', '-', 'negligible', f'{largest:.4f}'),
         Finding('largest velocity of the piston over c', '-', 'negligible',
                 f'{np.abs(trace.velocity("E")).max() * trace_slowness(trace):.5f}')),
        draw_mach)


def trace_slowness(trace: Trace) -> float:
    """Return 1/c [s/m] of the oil."""
    p = trace.parameters
    return math.sqrt(p['fluid.density'] / p['fluid.bulk_modulus'])


def draw_mach(figure) -> None:
    """Draw the largest |u|/c of the field over the first periods."""
    trace = reference()
    (axes,) = panels(figure, (UNITS, 'largest |u|/c in the field [1e-3]'))
    first = trace.units <= 2 * PERIOD
    axes.plot(trace.units[first], trace.mach[first] * MILLI, color=BLUE)


def reverse_flows(trace: Trace) -> dict[str, float]:
    """Return the largest reverse over the largest forward velocity at the four outer stations."""
    shares = {}
    for station in 'OAJK':
        velocity = trace.velocity(station)
        shares[station] = max(0.0, float(-velocity.min() / velocity.max()))
    return shares


def reverse_flow() -> Statement:
    """Judge the flow back towards the pump and back from the tank."""
    runs = {'16.25 Hz, full stroke': reverse_flows(reference()),
            '50 Hz, full stroke': reverse_flows(reference(*FAST)),
            '200 Hz, 0.3 of the stroke': reverse_flows(reference(*FASTER))}
    little = [max(shares.values()) < LITTLE for shares in runs.values()]
    return Statement(
        'reverse_flow',
        'In the supply and return line reverse flow is very small and can be neglected.',
        'section 7, figure 2a', True if all(little) else None if any(little) else False,
        'It is at the frequency of the figures. At the ends of pump and tank the waves of a '
        'closing valve swing the oil back, the more the faster it closes; at the valve next to '
        'none returns, as both pressures leave it no way.',
        tuple(Finding(f'largest reverse over largest forward velocity, {drive_}, at '
                      + ', '.join(shares), '%', 'very small',
                      ', '.join(f'{100 * share:.1f}' for share in shares.values()))
              for drive_, shares in runs.items()),
        draw_reverse)


def draw_reverse(figure) -> None:
    """Draw the velocities at the outer stations for two frequencies."""
    axes = panels(figure, (UNITS, 'velocity at 16.25 Hz [m/s]'),
                  (UNITS, 'velocity at 50 Hz [m/s]'))
    for one, trace, last in zip(axes, (reference(), reference(*FAST)), (PERIOD, 2 * FAST[0] / 20)):
        part = trace.units <= last
        for station, colour in zip('OAJK', (BLUE, SKY, ORANGE, VERMILION)):
            one.plot(trace.units[part], trace.velocity(station)[part], color=colour,
                     label=station, linewidth=1.0)
        one.axhline(0.0, color=GREY, linewidth=0.8)
    axes[0].legend(frameon=False, ncols=4, loc='lower center', bbox_to_anchor=(0.5, 1.0))


STATEMENTS = {
    'final_velocity': final_velocity, 'unequal_strokes': unequal_strokes,
    'equal_velocities': equal_velocities, 'mesh_deflection': mesh_deflection,
    'reverse_flow': reverse_flow}
