# SPDX-License-Identifier: Apache-2.0
"""
Many steps in one compiled call: inputs from a table, limits checked on the way.

The call allocates nothing and releases the interpreter lock. Time is the count of steps times
the step time, so any split of the steps gives the same bits.
"""

from hydra_actuator.core.boiling import count_cavities, note_lowest
from hydra_actuator.core.compilation import formula, kernel
from hydra_actuator.core.mass import add_flows, begin_balance, strike_balance, WEIGH_EVERY
from hydra_actuator.core.observe import find_limits, runs_away, SOUND
from hydra_actuator.core.step import step

# Steps between two looks at the limits: oil that is too fast is named as such before it grows
# into what is no number.
LOOK_EVERY = 32


@formula
def read_inputs(times, table, hold, cursor, time, inputs):
    """
    Write the inputs at `time` [s] and return the table row they start from.

    Linear between rows, or (hold) the last row whose time has come; constant beyond both ends.
    """
    while cursor + 1 < times.size and times[cursor + 1] <= time:
        cursor += 1
    weight = 0.0
    if not hold and cursor + 1 < times.size and time > times[cursor]:
        weight = (time - times[cursor]) / (times[cursor + 1] - times[cursor])
    for k in range(inputs.size):
        inputs[k] = table[cursor, k]
        if weight > 0.0:
            inputs[k] += weight * (table[cursor + 1, k] - table[cursor, k])
    return cursor


@kernel
def advance(model, state, passes, schedule, inputs, count, check_interval):
    """
    Advance `count` steps; return the status code (state.fault holds where and how much).

    schedule: (times (T,) [s], table (T, C), hold); inputs: work (C,), the inputs in force;
    check_interval: steps after which cavities are counted, and WEIGH_EVERY times it the oil is
    weighed; limits are checked then, every LOOK_EVERY steps, at the end, and where an end runs
    away.
    """
    times, table, hold = schedule
    cursor, code = 0, SOUND
    now, began = state, state.step[0]
    begin_balance(model, state)
    for _ in range(count):
        time = (state.step[0] + 1) * model.step_time
        cursor = read_inputs(times, table, hold, cursor, time, inputs)
        step(model, now, inputs, passes)
        now = now.exchanged
        add_flows(model, now)
        if state.step[0] % (WEIGH_EVERY * check_interval) == 0:
            strike_balance(model, now)
        if len(model.extras) > 0 and model.gas == 1:
            note_lowest(model, now)
            if state.step[0] % check_interval == 0:
                count_cavities(model, now)
        if (state.step[0] % LOOK_EVERY == 0 or state.step[0] % check_interval == 0
                or runs_away(model, now)):
            code, _ = find_limits(model, now)
            if code != SOUND:
                break
    if (state.step[0] - began) % 2 == 1:
        keep_level(state)
    if code == SOUND:
        code, _ = find_limits(model, state)
    return code


@formula
def keep_level(state):
    """Copy the new level of the waves to where the state of rest has it."""
    for i in range(state.wave_p.size):
        state.wave_p[i] = state.new_p[i]
        state.wave_q[i] = state.new_q[i]
