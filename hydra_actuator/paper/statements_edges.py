# SPDX-License-Identifier: Apache-2.0
"""
Statements on the two edges of the valve, and on models that leave the waves out.

The inlet edge is the one through which oil comes from the pump (A to B, or A to I with the valve
reversed), the outlet edge the one through which it goes to the tank. The first hundredth of the
opening is left out: there the edges exchange their parts.
"""

from functools import cache
import math
from typing import NamedTuple

from hydra_actuator.paper.drawing import BLUE, GREEN, ORANGE, panels, VERMILION
from hydra_actuator.paper.drive import (
    drive,
    FREQUENCY,
    PERIOD,
    reference,
    SECOND,
    sine,
    STEPS_BETWEEN,
    Trace,
    unit_time,
)
from hydra_actuator.paper.lumped import LumpedActuator, LumpedTrace
from hydra_actuator.paper.one_sided import one_sided
from hydra_actuator.paper.statement import Finding, Statement
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np

LEAST_OPENING = 0.01
SYMMETRIC = 0.02        # of the largest drop
POOR = 0.1              # of the right value: results 'not of high quality' are farther off
HALF = 0.5 * PERIOD
MEGA, MILLI = 1e-6, 1e3
UNITS = 'time [L/c]'
FAST = (5 * PERIOD * FREQUENCY / 50.0, 50.0, 1.0, 5)    # five periods of 50 Hz


def edge_drops(trace: Trace) -> tuple[np.ndarray, np.ndarray]:
    """Return the drops [Pa] over inlet and outlet edge, NaN where the valve is shut."""
    a, b, i, j = (trace.pressure(station) for station in 'ABIJ')
    direct = trace.spool > 0.0
    drops = np.where(direct, a - b, a - i), np.where(direct, i - j, b - j)
    shut = np.abs(trace.opening) <= LEAST_OPENING
    return np.where(shut, np.nan, drops[0]), np.where(shut, np.nan, drops[1])


@cache
def lumped_reference(duration: float = SECOND, frequency: float = FREQUENCY,
                     amplitude: float = 1.0, every: int = STEPS_BETWEEN) -> LumpedTrace:
    """Return the lumped model at the instants of the same reference."""
    trace = reference(duration, frequency, amplitude, every)
    return LumpedActuator(trace.parameters).follow(sine(frequency, amplitude), trace.time)


class Drops(NamedTuple):
    """Largest values over a run [Pa]: of a drop, and of the difference between both edges."""

    largest: float
    asymmetry: float        # of inlet less outlet drop
    lumped_largest: float
    lumped_asymmetry: float
    from_lumped: float      # inlet drop less that of the lumped model


def compare_drops(*run: float, until: float = math.inf) -> Drops:
    """
    Compare both edges in the reference and in the lumped model.

    run: of reference(); until: end of what is compared, in units of L/c.
    """
    trace, lumped = reference(*run), lumped_reference(*run)
    shut = np.where((np.abs(trace.opening) <= LEAST_OPENING) | (trace.units > until), np.nan, 0.0)
    inlet, outlet = edge_drops(trace)
    return Drops(*(float(np.nanmax(np.abs(values + shut))) for values in (
        inlet, inlet - outlet, lumped.inlet_drop, lumped.inlet_drop - lumped.outlet_drop,
        inlet - lumped.inlet_drop)))


def start_at_supply_pressure() -> tuple[float, float]:
    """Return the largest differences [Pa] of both drops in the first and second half period."""
    pressure = paper_parameters()['supply.pressure']
    trace = reference(PERIOD, initial__pressure_1=pressure, initial__pressure_2=pressure)
    inlet, outlet = edge_drops(trace)
    difference, late = np.abs(inlet - outlet), trace.units > HALF
    return float(np.nanmax(difference[~late])), float(np.nanmax(difference[late]))


def symmetric_drops() -> Statement:
    """Judge whether waves make the drops over both edges differ."""
    slow, fast, half = compare_drops(), compare_drops(*FAST), compare_drops(until=HALF)
    trace = reference()
    inlet, outlet = edge_drops(trace)
    first, second = start_at_supply_pressure()
    differ = slow.asymmetry > SYMMETRIC * slow.largest
    return Statement(
        'symmetric_drops',
        'The drops at the inlet and outlet edge of the valve are equal in a quasi-static model '
        'and unequal in this one.',
        'section 7, figures 3e and 3f', differ,
        f'The solver keeps both drops equal within {100 * slow.asymmetry / slow.largest:.2g} %, '
        f'the lumped model within {100 * slow.lumped_asymmetry / slow.lumped_largest:.2g} %: oil '
        'that is compressed and a piston off its middle make that much without any wave. Waves '
        'change the drop itself, on both edges alike. Unequal they are only while chambers that '
        "start at supply pressure, as the paper's do, empty into the first half period.",
        (Finding('largest difference of both drops, waves', 'MPa', 'unequal',
                 f'{slow.asymmetry * MEGA:.3f} of {slow.largest * MEGA:.2f}'),
         Finding('the same in the first half period', 'MPa', 'unequal',
                 f'{half.asymmetry * MEGA:.3f} of {half.largest * MEGA:.2f}'),
         Finding('largest difference of both drops, lumped model', 'MPa', 'equal',
                 f'{slow.lumped_asymmetry * MEGA:.3f} of {slow.lumped_largest * MEGA:.2f}'),
         Finding('inlet and outlet drop at the last moment', 'MPa', 'unequal',
                 f'{inlet[-1] * MEGA:.3f} and {outlet[-1] * MEGA:.3f}'),
         Finding('inlet drop, waves less lumped model, at most', 'MPa', '-',
                 f'{slow.from_lumped * MEGA:.2f}'),
         Finding('largest difference of both drops at 50 Hz, waves', 'MPa', '-',
                 f'{fast.asymmetry * MEGA:.3f} of {fast.largest * MEGA:.2f}'),
         Finding('the same, lumped model', 'MPa', '-',
                 f'{fast.lumped_asymmetry * MEGA:.3f} of {fast.lumped_largest * MEGA:.2f}'),
         Finding('chambers start at supply pressure: first half period', 'MPa', '-',
                 f'{first * MEGA:.2f}'),
         Finding('the same, second half period', 'MPa', '-', f'{second * MEGA:.3f}')),
        draw_drops)


def draw_drops(figure) -> None:
    """Draw both drops in the first period, and inlet less outlet over the whole run."""
    trace, lumped = reference(), lumped_reference()
    inlet, outlet = edge_drops(trace)
    left, right = panels(figure, (UNITS, 'drop over an edge [MPa]'),
                         (UNITS, 'inlet less outlet drop [MPa]'))
    first = trace.units <= PERIOD
    for values, colour, dash, label in (
            (inlet, BLUE, '-', 'inlet, waves'), (outlet, ORANGE, '--', 'outlet, waves'),
            (lumped.inlet_drop, GREEN, ':', 'inlet, lumped')):
        left.plot(trace.units[first], values[first] * MEGA, dash, color=colour, label=label)
    left.legend(frameon=False, ncols=3, loc='lower center', bbox_to_anchor=(0.5, 1.0))
    shut = np.isnan(inlet)
    for values, colour, label in (
            (inlet - outlet, BLUE, 'waves'),
            (lumped.inlet_drop - lumped.outlet_drop, ORANGE, 'lumped')):
        right.plot(trace.units, np.where(shut, np.nan, values * MEGA), color=colour, label=label,
                   linewidth=0.9)
    right.set_xlim(0, 4 * PERIOD)
    right.legend(frameon=False, ncols=2, loc='lower center', bbox_to_anchor=(0.5, 1.0))


@cache
def one_sided_half_period() -> Trace:
    """Return the one-sided actuator over the direct half of the first period."""
    p = one_sided(paper_parameters())
    trace = drive(p, sine(FREQUENCY), HALF * unit_time(p), STEPS_BETWEEN)
    return Trace(p, trace.channels, trace.rows[trace.units <= HALF])


def one_sided_model() -> Statement:
    """Judge the one-sided model against the whole one in the first half period."""
    half, whole = one_sided_half_period(), reference()
    part = whole.units <= HALF
    inlet, outlet = (np.nanmax(values[part]) for values in edge_drops(whole))
    lone, beyond = (float(np.nanmax(np.abs(values))) for values in edge_drops(half))
    travel, full = float(half.position[-1]), float(whole.position[part][-1])
    off = abs(travel / full - 1.0)
    return Statement(
        'one_sided_model',
        'The simplified one-sided actuator, its return side quasi-static at zero pressure, is of '
        'interest but gives results that are not of high quality.',
        'section 5', off > POOR,
        f'It moves the piston {100 * off:.0f} % farther: the whole supply pressure falls over '
        f'one edge instead of two, {lone / inlet:.2f} times as much, and one column of oil '
        'instead of two holds the piston.',
        (Finding('piston after half a period, one-sided', 'mm', '-', f'{travel * MILLI:.2f}'),
         Finding('piston after half a period, whole', 'mm', '-', f'{full * MILLI:.2f}'),
         Finding('largest inlet drop, one-sided', 'MPa', '-', f'{lone * MEGA:.2f}'),
         Finding('largest inlet drop, whole', 'MPa', '-', f'{inlet * MEGA:.2f}'),
         Finding('largest outlet drop, one-sided', 'MPa', '0',
                 f'{beyond * MEGA:.3f}'),
         Finding('largest outlet drop, whole', 'MPa', '-', f'{outlet * MEGA:.2f}'),
         Finding('largest velocity at A, one-sided', 'm/s', '-',
                 f'{half.velocity("A").max():.2f}'),
         Finding('largest velocity at A, whole', 'm/s', '-',
                 f'{whole.velocity("A")[part].max():.2f}')),
        draw_one_sided)


def draw_one_sided(figure) -> None:
    """Draw piston and inlet drop of three models over the first half period."""
    half, whole, lumped = one_sided_half_period(), reference(), lumped_reference()
    left, right = panels(figure, (UNITS, 'piston [mm]'), (UNITS, 'drop over the inlet edge [MPa]'))
    part = whole.units <= HALF
    for units, position, drop, colour, dash, label in (
            (whole.units[part], whole.position[part], edge_drops(whole)[0][part], BLUE, '-',
             'whole, waves'),
            (whole.units[part], lumped.position[part], lumped.inlet_drop[part], GREEN, ':',
             'whole, lumped'),
            (half.units, half.position, edge_drops(half)[0], VERMILION, '-', 'one-sided')):
        left.plot(units, position * MILLI, dash, color=colour, label=label)
        right.plot(units, drop * MEGA, dash, color=colour)
    left.legend(frameon=False)


def wave_parts(trace: Trace) -> tuple[np.ndarray, np.ndarray]:
    """Return pressure [Pa] at A and J less what the flow there gives without waves."""
    p, parts = trace.parameters, []
    for station, line, end in (('A', 'supply_line', p['supply.pressure']),
                               ('J', 'return_line', p['tank.pressure'])):
        u = trace.velocity(station)
        loss = 0.5 * p['fluid.density'] * p[f'{line}.loss_coefficient'] * p[f'{line}.length']
        parts.append(trace.pressure(station) - end + (loss if station == 'A' else -loss)
                     * u * np.abs(u))
    return parts[0], parts[1]


def return_waves() -> Statement:
    """Judge the waves of the return line against those of the supply line."""
    found = [tuple(float(np.abs(part).max()) for part in wave_parts(trace))
             for trace in (reference(), reference(*FAST))]
    (supply, back), (fast_supply, fast_back) = found
    small = back < POOR * supply
    return Statement(
        'return_waves', 'Wave effects of the return flow are very small.', 'section 3', small,
        f'At J they are {back / supply:.2f} times those at A: whatever the valve takes from '
        'the supply line it gives to the return line, and an equal line answers with equal waves '
        'of opposite sign. Small they are beside the pressure of a chamber, not beside the '
        "tank's.",
        (Finding('pressure at A less its quasi-static value, at most', 'MPa', '-',
                 f'{supply * MEGA:.3f}'),
         Finding('pressure at J less its quasi-static value, at most', 'MPa', 'very small',
                 f'{back * MEGA:.3f}'),
         Finding('the same at A, 50 Hz', 'MPa', '-', f'{fast_supply * MEGA:.3f}'),
         Finding('the same at J, 50 Hz', 'MPa', 'very small', f'{fast_back * MEGA:.3f}')),
        draw_return_waves)


def draw_return_waves(figure) -> None:
    """Draw the waves at A and J over the first period."""
    trace = reference()
    (axes,) = panels(figure, (UNITS, 'pressure less its quasi-static value [MPa]'))
    first = trace.units <= PERIOD
    for part, colour, label in zip(wave_parts(trace), (BLUE, VERMILION),
                                   ('A, supply line', 'J, return line')):
        axes.plot(trace.units[first], part[first] * MEGA, color=colour, label=label)
    axes.legend(frameon=False)


STATEMENTS = {
    'symmetric_drops': symmetric_drops, 'one_sided_model': one_sided_model,
    'return_waves': return_waves}
