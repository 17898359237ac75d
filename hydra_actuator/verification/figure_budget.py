# SPDX-License-Identifier: Apache-2.0
"""Figures of mass and energy through two lines and an orifice."""

from hydra_actuator.verification import budget, whole_budget
from hydra_actuator.verification.case import illustrated
from hydra_actuator.verification.drawing import (
    bar,
    EXACT_LINE,
    GREEN,
    MEGAPASCAL,
    MILLI,
    ORANGE,
    SERIES,
    SOLVER,
)
import numpy as np

BINS = 120              # of the run's 60 ms


def draw_mass_balance(figure) -> None:
    """Draw what flows in and out, and what is missing at each weighing."""
    above, below = figure.subplots(2, sharex=True, height_ratios=(3, 2))
    ledger = budget.keep_ledger(200, 2e6)
    time = MILLI * ledger.step_time * np.arange(len(ledger.mass_flow))
    for end, sign, label, colour in ((budget.INLET, -1.0, 'into line 1', SERIES[0]),
                                     (budget.M, 1.0, 'through the orifice', SERIES[2]),
                                     (budget.OUTLET, 1.0, 'out of line 2', SERIES[1])):
        above.plot(time, sign * ledger.mass_flow[:, end], color=colour, linewidth=1.2,
                   label=label)
    above.set_ylabel('mass flow [kg/s]')
    for cells, colour in ((200, SERIES[0]), (400, SERIES[1])):
        ledger = budget.keep_ledger(cells, 2e6)
        weighings = range(1, len(ledger.weighed))
        below.plot(MILLI * ledger.step_time * ledger.weighed[1:],
                   np.abs([ledger.mass_missing(k) for k in weighings]), '.-', color=colour,
                   linewidth=0.8, label=f'{cells} cells')
    bar(below, budget.MASS_BAR)
    below.set_yscale('log')
    below.set_ylabel('|in - out - stored|, of throughput')
    below.set_xlabel('time after the warm-up [ms]')
    for axes in (above, below):
        axes.grid(True)
        axes.legend(ncols=3, loc='lower right', bbox_to_anchor=(1.0, 1.0), borderpad=0)


def draw_orifice_law(figure) -> None:
    """Draw drop over flow at every step against the law, and both errors."""
    left, right = figure.subplots(1, 2)
    flows = []
    for (name, swing), colour in zip(budget.SWINGS.items(), (SERIES[0], SERIES[1])):
        ledger = budget.keep_ledger(100, swing)
        q = ledger.mass_flow[:, budget.M] / budget.DENSITY
        flows += [q.min(), q.max()]
        drop = ledger.pressure[:, budget.M] - ledger.pressure[:, budget.N]
        left.plot(1e3 * q, MEGAPASCAL * drop, color=colour, linewidth=1.2, zorder=3,
                  label=f'solver, {name}')
        for errors, what, marker in zip(budget.law_errors(name), ('mass', 'law'), ('.', '+')):
            worst = [np.abs(part).max() for part in np.array_split(errors, BINS)]
            time = MILLI * ledger.step_time * len(q) * (np.arange(BINS) + 0.5) / BINS
            right.plot(time, worst, marker, color=colour, markersize=5,
                       label=f'{what}, {name}')
    flow = np.linspace(min(flows), max(flows), 201)
    left.plot(1e3 * flow, MEGAPASCAL * flow * np.abs(flow) / budget.COEFFICIENT ** 2, **{
        **EXACT_LINE, 'label': r'exact, $\rho_0 q|q| / 2 K^2$'})
    left.set_xlabel('flow at reference density [l/s]')
    left.set_ylabel('pressure drop [MPa]')
    left.legend()
    bar(right, budget.LAW_BAR)
    right.set_yscale('log')
    right.set_ylim(1e-16, 1e-8)
    right.set_xlabel('time after the warm-up [ms]')
    right.set_ylabel('largest relative error in each half millisecond')
    right.legend(ncols=2, loc='upper right')
    for axes in (left, right):
        axes.grid(True)


def draw_energy_budget(figure) -> None:
    """Draw where the energy goes: in parts of what came in, down to what is not accounted for."""
    found = budget.budget()
    left, right = figure.subplots(1, 2, width_ratios=(2.0, 1.0))
    parts = {'out': found.went, **found.losses, 'stored': found.kept}
    start = found.came
    left.bar('in', start, color=SOLVER['color'], width=0.7)
    left.text(0, start, f'{start:.3f} J', ha='center', va='bottom', fontsize=8)
    for k, (name, part) in enumerate(parts.items(), 1):
        left.bar(name.replace(' of ', '\nof '), part, bottom=start - part, width=0.7,
                 color=GREEN if name in ('out', 'stored') else ORANGE)
        left.text(k, start, f'{part:.3f} J', ha='center', va='bottom', fontsize=8)
        left.plot((k - 1.35, k + 0.35), (start, start), color='#59636e', linewidth=0.7)
        start -= part
    left.set_ylabel('energy [J]')
    left.set_title('what came in, less what went out, was lost and was stored', loc='left')
    left.margins(y=0.08)
    rest = abs(start) / found.came
    right.bar(('not\naccounted for',), (rest,), width=0.5, color=SOLVER['color'])
    right.text(0, rest, f'{rest:.1e}', ha='center', va='bottom')
    bar(right, budget.ENERGY_BAR)
    right.set_yscale('log')
    right.set_ylim(1e-12, 1e-7)
    right.set_xlim(-1.0, 1.0)
    right.set_ylabel('of what came in')
    right.legend()
    for axes in (left, right):
        axes.grid(True, axis='y')


def draw_whole_budget(figure) -> None:
    """Draw where the energy of each drive goes, and what of mass, energy and work is missing."""
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    measures = {'mass': 'mass_missing', 'energy': 'energy_missing', 'piston': 'work_missing'}
    for k, (name, drive) in enumerate(whole_budget.DRIVES.items()):
        ledger = whole_budget.keep_ledger(name, 200)
        losses = ledger.losses()
        place = np.arange(len(losses)) + 0.4 * (k - 0.5)
        left.barh(place, [max(loss, 1e-3) for loss in losses.values()], height=0.36,
                  color=SERIES[k], label=f'{name}, {1e3 * (drive.end - drive.begin):.0f} ms')
        for y, loss in zip(place, losses.values()):
            left.text(1.15 * max(loss, 1e-3), y, f'{loss:.3g} J', va='center', fontsize=8)
        left.set_yticks(range(len(losses)), list(losses))
        bars = (drive.mass_bar, drive.energy_bar, drive.work_bar)
        for j, (method, tolerance) in enumerate(zip(measures.values(), bars)):
            at = j + 0.4 * (k - 0.5)
            for cells, marker in ((100, 'o'), (200, 's')):
                missing = abs(getattr(whole_budget.keep_ledger(name, cells), method)())
                right.plot(at, missing, marker, color=SERIES[k], markersize=6,
                           label=f'{name}, {cells} cells' if j == 0 else '_')
            right.hlines(tolerance, at - 0.17, at + 0.17, color='#d55e00', linestyle='--',
                         linewidth=1.2, label='tolerance' if j == k == 0 else '_')
    left.set_xscale('log')
    left.set_xlim(1e-3, 1e5)
    left.invert_yaxis()
    left.set_xlabel('energy that left the oil [J]')
    left.legend(loc='lower right')
    right.set_yscale('log')
    right.set_ylim(1e-10, 3e-1)
    right.set_xticks(range(len(measures)), list(measures))
    right.set_ylabel('not accounted for, of throughput')
    right.legend(loc='upper right', ncols=2, fontsize=7)
    for axes in (left, right):
        axes.grid(True)


CASES = {
    **illustrated(budget.CASES, mass_balance=draw_mass_balance,
                  orifice_law=draw_orifice_law, energy_budget=draw_energy_budget),
    **illustrated(whole_budget.CASES, whole_budget=draw_whole_budget),
}
