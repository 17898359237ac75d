# SPDX-License-Identifier: Apache-2.0
"""
Many steps of four actuators in one compiled call, or none at all.

Where a lane comes near a limit the call gives up and leaves every state as it was: each actuator
alone then does these steps, and finds the limit, or passes it, as it always does.
"""

from hydra_actuator.core.advance import LOOK_EVERY, read_inputs
from hydra_actuator.core.choices import all_at_most
from hydra_actuator.core.compilation import formula, kernel
from hydra_actuator.core.lanes import element, WIDTH
from hydra_actuator.core.together.exchange import enter, leave
from hydra_actuator.core.together.step import step_together


@kernel
def advance_together(ensemble, members, passes, feed, count):
    """
    Advance `count` steps each; return whether that was done.

    members: (models, states, shadows) of the lanes; feed: (schedules of the lanes, inputs
    (WIDTH, C), check intervals (WIDTH,)), each as of hydra_actuator.core.advance.
    """
    models, states, shadows = members
    schedules, inputs, looks = feed
    for lane in range(WIDTH):
        enter(ensemble, lane, models[lane], states[lane], shadows[lane])
        ensemble.cursor[lane] = 0
    now = ensemble
    for _ in range(count):
        for lane in range(WIDTH):
            times, table, hold = schedules[lane]
            time = (shadows[lane].step[0] + 1) * ensemble.step_time[lane]
            ensemble.cursor[lane] = read_inputs(
                times, table, hold, ensemble.cursor[lane], time, inputs[lane])
            for k in range(inputs.shape[1]):
                ensemble.feed[WIDTH * k + lane] = inputs[lane, k]
        if not step_together(now, models, shadows, inputs, passes):
            return False
        now = now.exchanged
        if ends_run_away(now):
            return False
        for lane in range(WIDTH):
            step = shadows[lane].step[0]
            if (step % LOOK_EVERY == 0 or step % looks[lane] == 0) and is_fast(now, lane):
                return False
    for lane in range(WIDTH):
        if is_fast(now, lane):
            return False
    for lane in range(WIDTH):
        leave(now, lane, models[lane], states[lane], shadows[lane])
    return True


@formula
def ends_run_away(now):
    """Return whether oil leaves an end at nearly the allowed speed, or at no number."""
    for end in range(2 * now.start.size):
        if not all_at_most(abs(element(now.end_velocity, end)), element(now.fastest, end // 2)):
            return True
    return False


@formula
def is_fast(now, lane):
    """Return whether the oil of a lane is somewhere nearly too fast, or no number."""
    for d in range(now.start.size):
        at = WIDTH * d + lane
        most = 2.0 * now.fastest[at]
        first = WIDTH * now.start[d] + lane
        for i in range(first, first + WIDTH * (now.last[at] + 1), WIDTH):
            if not abs(now.wave_p[i] - now.wave_q[i]) <= most:
                return True
        if now.moving[d] == 1:
            if not abs(now.face_p[at] - now.face_q[WIDTH * 3 * d + lane]) <= most:
                return True
    return False
