# SPDX-License-Identifier: Apache-2.0
"""Statements on a throttle that moves fast: the drop at A, how to suppress it, relation (10)."""

from functools import cache
from itertools import pairwise
import math

from hydra_actuator.actuator import Actuator
from hydra_actuator.geometry import wave_speed
from hydra_actuator.paper.drawing import BLUE, GREEN, GREY, ORANGE, panels, PURPLE, SKY, VERMILION
from hydra_actuator.paper.drive import drive, frames, opening, Trace
from hydra_actuator.paper.statement import Finding, Statement
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

TARGET = 0.3                # of the stroke
DURATIONS = (0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3)   # of the opening [s]
SEEN = 0.02                 # after the start [s]
RAMP, PART = 0.5e-3, 0.15   # of the opening and partial closing: duration [s], what stays open
STARTS = np.arange(0.0, 4.01e-3, 0.25e-3)               # of the closing [s]
CLOSING_SEEN = 8e-3
FINE_CELLS = 800            # of 2.5 mm: a field in single precision resolves the slopes
FIRST, CLOSE = 20e-6, 0.05  # judged at [s]; of one
IMPACT_SEEN, IMPACT_EVERY = 100e-6, 2
MEGA, MILLI, MICRO = 1e-6, 1e3, 1e6
COLOURS = (VERMILION, ORANGE, PURPLE, GREEN, SKY, BLUE)


@cache
def opened(duration: float) -> Trace:
    """Return the actuator whose valve opens to TARGET in a duration [s]."""
    return drive(paper_parameters(), opening(TARGET, duration), SEEN, 2)


def drop_at_a(trace: Trace) -> float:
    """Return the largest drop [Pa] of the pressure at A below the supply."""
    return float(trace.parameters['supply.pressure'] - trace.pressure('A').min())


def swing_time() -> float:
    """Return the period [s] in which the supply line swings, 4 L/c: pump open, valve shut."""
    p = paper_parameters()
    return 4.0 * p['supply_line.length'] / wave_speed(p, 'supply_line')


def faster_throttle() -> Statement:
    """Judge whether a faster throttle makes a larger drop at A."""
    drops = [drop_at_a(opened(duration)) for duration in DURATIONS]
    return Statement(
        'faster_throttle',
        'The pressure drop that the expansion wave makes before the valve grows with the velocity '
        'of the throttle.',
        'section 1', all(a > b for a, b in pairwise(drops)),
        f'An opening slower than the {0.5 * swing_time() * MILLI:.2f} ms in which the wave runs '
        'to the pump and back is met by its own reflection; a faster one can gain no more than '
        'the sudden drop.',
        tuple(Finding(f'largest drop at A, opening to {TARGET:g} in {duration * MILLI:g} ms',
                      'MPa', 'grows with velocity', f'{drop * MEGA:.2f}')
              for duration, drop in zip(DURATIONS, drops)),
        draw_throttle)


def draw_throttle(figure) -> None:
    """Draw the pressure at A for all durations, and the drop over the duration."""
    left, right = panels(figure, ('time [ms]', 'pressure at A [MPa gauge]'),
                         ('duration of the opening [ms]', 'largest drop at A [MPa]'))
    for duration, colour in zip(DURATIONS, COLOURS):
        trace = opened(duration)
        part = trace.time <= 8e-3
        left.plot(trace.time[part] * MILLI, trace.pressure('A')[part] * MEGA, color=colour,
                  linewidth=1.0, label=f'{duration * MILLI:g} ms')
    left.legend(frameon=False, ncols=6, fontsize=8, columnspacing=1.0, handlelength=1.2,
                loc='lower center', bbox_to_anchor=(0.5, 1.0))
    right.semilogx([duration * MILLI for duration in DURATIONS],
                   [drop_at_a(opened(duration)) * MEGA for duration in DURATIONS], 'o-',
                   color=BLUE)
    right.set_xticks([duration * MILLI for duration in DURATIONS],
                     [f'{duration * MILLI:g}' for duration in DURATIONS])
    right.minorticks_off()


@cache
def partly_closed(start: float) -> Trace:
    """Return the valve opened to TARGET in RAMP and closed to PART in RAMP from a start [s] on."""
    def command(times: np.ndarray) -> np.ndarray:
        closing = np.clip((times - start) / RAMP, 0.0, 1.0)
        return opening(TARGET, RAMP)(times) - (TARGET - PART) * closing

    return drive(paper_parameters(), command, CLOSING_SEEN, 4)


def later_drop(trace: Trace, start: float) -> float:
    """Return the largest drop [Pa] at A from the end of a closing on."""
    later = trace.pressure('A')[trace.time >= start + RAMP]
    return float(trace.parameters['supply.pressure'] - later.min())


def partial_closing() -> Statement:
    """Judge whether partial closing suppresses the drop at A."""
    still = partly_closed(math.inf)
    alone = drop_at_a(still)
    whole = np.array([drop_at_a(partly_closed(start)) for start in STARTS])
    later = np.array([later_drop(partly_closed(start), start) for start in STARTS])
    left_alone = np.array([later_drop(still, start) for start in STARTS])
    gain = later / left_alone
    best, worst = int(gain.argmin()), int(whole.argmax())
    helps, harms = gain[best] < 1.0 and whole[0] < alone, whole[worst] > alone
    return Statement(
        'partial_closing', 'Partial closing of the throttle suppresses that drop.', 'section 1',
        None if helps and harms else bool(helps),
        f'It depends on timing. The closing sends a compression wave into a line that swings with '
        f'4 L/c = {swing_time() * MILLI:.2f} ms: in step with the swing it cancels it, half a '
        'period off it feeds it.',
        (Finding(f'largest drop at A, opened to {TARGET:g} in {RAMP * MILLI:g} ms, not closed',
                 'MPa', '-', f'{alone * MEGA:.2f}'),
         Finding(f'closed to {PART:g} at once', 'MPa', 'less', f'{whole[0] * MEGA:.2f}'),
         Finding(f'closed from {STARTS[worst] * MILLI:.2f} ms on, the worst start', 'MPa', 'less',
                 f'{whole[worst] * MEGA:.2f}'),
         Finding(f'drop that is left after closing from {STARTS[best] * MILLI:.2f} ms on, the '
                 'best start', 'MPa', 'less', f'{later[best] * MEGA:.2f}'),
         Finding('drop from that instant on, not closed', 'MPa', '-',
                 f'{left_alone[best] * MEGA:.2f}')),
        draw_closing)


def draw_closing(figure) -> None:
    """Draw the pressure at A for some starts of the closing, and the drops over the start."""
    left, right = panels(figure, ('time [ms]', 'pressure at A [MPa gauge]'),
                         ('start of the closing [ms]', 'largest drop at A [MPa]'))
    for start, colour, label in ((math.inf, GREY, 'not closed'), (0.75e-3, VERMILION, '0.75 ms'),
                                 (1.75e-3, BLUE, '1.75 ms')):
        trace = partly_closed(start)
        left.plot(trace.time * MILLI, trace.pressure('A') * MEGA, color=colour, label=label)
    left.legend(frameon=False, ncols=3, loc='lower center', bbox_to_anchor=(0.5, 1.0))
    whole = [drop_at_a(partly_closed(start)) * MEGA for start in STARTS]
    later = [later_drop(partly_closed(start), start) * MEGA for start in STARTS]
    right.plot(STARTS * MILLI, whole, 'o-', color=VERMILION, label='over all')
    right.plot(STARTS * MILLI, later, 's-', color=BLUE, label='after the closing')
    right.axhline(drop_at_a(partly_closed(math.inf)) * MEGA, color=GREY, label='not closed')
    right.legend(frameon=False, ncols=3, loc='lower center', bbox_to_anchor=(0.5, 1.0))


@cache
def impact_ratios(duration: float) -> np.ndarray:
    """
    Return (time [s], right over left side of (10) at A, the same at B), shape (N, 3).

    The valve opens to TARGET in a duration [s]; the slope of the pressure is the one-sided
    difference of second order, on cells of 2.5 mm, once the wave has crossed its three nodes.
    """
    p = paper_parameters().replace({'solver.cells': FINE_CELLS})
    actuator = Actuator(p)
    x, labels = actuator.field_positions, np.array(actuator.field_labels)
    at_a = np.flatnonzero(labels == 'supply_line')[:-4:-1]
    at_b = np.flatnonzero(labels == 'line_1')[:3]
    speed = (p['valve.discharge_coefficient'] * p['valve.area_gradient'] * p['valve.stroke']
             * TARGET / duration)
    area = 0.25 * math.pi * p['line_1.diameter'] ** 2
    out, rows = np.empty((len(labels), 2), np.float32), []
    for seen in frames(actuator, opening(TARGET, duration), IMPACT_SEEN, IMPACT_EVERY):
        seen.read_field(out)
        pressure = out[:, 0].astype(float)
        drop = pressure[at_a[0]] - pressure[at_b[0]]
        impact = speed * math.sqrt(2.0 * drop / p['fluid.density'])
        slopes = [(-1.5 * pressure[i] + 2.0 * pressure[j] - 0.5 * pressure[k]) / (x[j] - x[i])
                  for i, j, k in (at_a, at_b)]
        rows.append((seen.time, *(-area / p['fluid.density'] * slope / impact
                                  for slope in slopes)))
    reached = (x[at_a[0]] - x[at_a[-1]]) / wave_speed(p)
    return np.array([row for row in rows if row[0] > reached])


def impact_relation() -> Statement:
    """Judge relation (10) at both sides of the edge that opens."""
    at_first = {}
    for duration in DURATIONS[::2]:
        time, *ratios = impact_ratios(duration).T
        at_first[duration] = [float(np.interp(FIRST, time, ratio)) for ratio in ratios]
    off = max(abs(ratio - 1.0) for pair in at_first.values() for ratio in pair)
    return Statement(
        'impact_relation',
        'The velocity of the throttle and the slope of the pressure on both sides of it are tied '
        'by C_d w (dx/dt) sqrt(2 dp/rho0) = -(A/rho0) dp/dx.',
        'equation 10', off < CLOSE,
        'It is the limit of the first instant: it leaves out the change of dp with the flow, '
        'which grows with time.',
        tuple(Finding(f'right over left side after {FIRST * MICRO:g} us at A and B, opening in '
                      f'{duration * MILLI:g} ms', '-', '1', f'{a:.3f} and {b:.3f}')
              for duration, (a, b) in at_first.items()),
        draw_impact)


def draw_impact(figure) -> None:
    """Draw the ratio of both sides of (10) over time."""
    (axes,) = panels(figure, ('time [us]', 'right over left side of (10) [1]'))
    for duration, colour in zip(DURATIONS[::2], (VERMILION, ORANGE, BLUE)):
        time, at_a, at_b = impact_ratios(duration).T
        axes.plot(time * MICRO, at_a, color=colour, label=f'A, {duration * MILLI:g} ms')
        axes.plot(time * MICRO, at_b, '--', color=colour, label=f'B, {duration * MILLI:g} ms')
    axes.set_ylim(0.8, 1.05)
    axes.legend(frameon=False, ncols=3)


STATEMENTS = {
    'faster_throttle': faster_throttle, 'partial_closing': partial_closing,
    'impact_relation': impact_relation}
