# SPDX-License-Identifier: Apache-2.0
"""
The loop: wait for the grid, note the command, solve the period that ends now, show the row.

What it does in each tick is what hydra_actuator.ros.plant does with a grant, without the
interpreter: on a machine where others hold that, the loop is as punctual as the system lets it.
"""

from typing import NamedTuple

from hydra_actuator.core.advance import advance
from hydra_actuator.core.compilation import formula, kernel
from hydra_actuator.core.observe import observe, read_field, SOUND
from hydra_actuator.realtime import durations, grid, held, memory
from hydra_actuator.realtime.system import monotonic, publish_stores, sleep_until, wake
from hydra_actuator.solver import note_extremes
import numpy as np

# Why the loop has ended, if not by a status code of the solver, which are above 0.
ASKED, HALTED, DONE = 0, -1, -2

# rows: number of the next; base: stamp [ns] of grid index 0; period: simulated time of a tick
# [ns]; stamp: of the last row [ns]; share: frames of the field per tick.
PROGRESS = np.dtype([
    ('rows', np.int64), ('base', np.int64), ('period', np.float64), ('stamp', np.int64),
    ('share', np.float64)], align=True)

_sample = formula(held.sample)
_count = formula(durations.count_duration)
_next_instant, _release = formula(grid.next_instant), formula(grid.release)
_fill_tick, _fill_frame = formula(memory.fill_tick), formula(memory.fill_frame)
_frame_is_due = formula(memory.frame_is_due)
_note_extremes = formula(note_extremes)


class Desk(NamedTuple):
    """
    What the loop shares with others, beside the solver's own.

    attention (1,): not 0 where the loop is to end; inputs (3,): held during the next tick;
    words: see hydra_actuator.realtime.system; lateness, execution: bins and totals.
    """

    attention: np.ndarray
    progress: np.ndarray
    grid: np.ndarray
    lateness: tuple[np.ndarray, np.ndarray]
    execution: tuple[np.ndarray, np.ndarray]
    held: held.Held
    inputs: np.ndarray
    memory: memory.Memory
    words: np.ndarray


@formula
def await_instant(desk):
    """Wait for the next tick; return its grid index, or HALTED."""
    words = desk.words
    now = monotonic(words)
    released = desk.grid[0]['released']
    if released >= 0:
        _count(desk.execution[0], desk.execution[1], now - released)
    index, due = _next_instant(desk.grid, now)
    if desk.grid[0]['halted'] == 1:
        return HALTED
    while now < due:
        sleep_until(words, due)
        now = monotonic(words)
    _count(desk.lateness[0], desk.lateness[1], now - due)
    _release(desk.grid, index, now)
    return index


@formula
def show(desk, solver, tick, descriptor):
    """Put the row, and the field if it is due, where the reader finds them; wake it."""
    progress, written = desk.progress[0], desk.memory.written[0]
    number, stamp = progress['rows'], progress['stamp']
    slot = _fill_tick(desk.memory, number, stamp, tick, desk.inputs)
    for k in range(solver.row.size):
        desk.memory.rows[slot, k] = solver.row[k]
    publish_stores()
    written['ticks'] += 1
    if _frame_is_due(progress['share'], number):
        frame = desk.memory.fields[written['frames'] % desk.memory.frames.size]
        read_field(solver.model, solver.state, solver.ambient, frame)
        _fill_frame(desk.memory, stamp, solver.state.step[0] * solver.model.step_time)
        publish_stores()
        written['frames'] += 1
    progress['rows'] = number + 1
    wake(desk.words, descriptor)


@kernel
def tick_on_grid(desk, solver, enabled, descriptor, most):
    """
    Tick until asked to end, at most `most` times; return ASKED, HALTED, DONE or a status code.

    solver: hydra_actuator.solver.Solver; enabled: whether spool commands reach the valve;
    descriptor: wakes the reader. A tick whose solution is not sound is not shown.
    """
    progress, inputs = desk.progress[0], desk.inputs
    times, table, hold = solver.schedule
    for _ in range(most):
        index = await_instant(desk)
        if index == HALTED:
            return HALTED
        progress['stamp'] = progress['base'] + round(index * progress['period'])
        spool_1, spool_2, load_force = _sample(desk.held, desk.grid[0]['released'])
        for k in range(3):
            table[0, k] = inputs[k]
        tick = solver.state.step[0] // solver.steps
        code = advance(solver.model, solver.state, solver.passes, solver.schedule,
                       solver.inputs, solver.steps, solver.steps)
        observe(solver.model, solver.state, solver.sections, solver.ambient, solver.inputs,
                solver.row)
        _note_extremes(solver.extremes, solver.row, solver.lowest)
        if code != SOUND:
            return code
        show(desk, solver, tick, descriptor)
        inputs[0], inputs[1], inputs[2] = spool_1, spool_2, load_force
        if enabled == 0:
            inputs[0], inputs[1] = 0.0, 0.0
        if desk.attention[0] != 0:
            return ASKED
    return DONE
