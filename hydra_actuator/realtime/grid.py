# SPDX-License-Identifier: Apache-2.0
"""
The grid's arithmetic: which instant comes next, and what was missed.

The grid is origin + g * period for g = 1, 2, ...; a tick is released at a grid instant and is
due at the next one, when the following tick is released. A loop that comes back late by
`lateness` has let ceil(lateness / period) grid instants pass; each is counted once as missed,
however long the loop then takes to catch up. What becomes of them is the overrun policy:

- `burst`: up to `max_burst` ticks are run at once, one after the other; the rest is slip,
- `slip`: all of them are slip,
- `halt`: no further tick is granted.

Slip is a declared shift of the grid by whole periods, so that at all times, without rounding,

    grid index of a tick = ticks granted + slipped        (no drift, ever).
"""

import math

import numpy as np

# period [ns]; origin, released (when the last tick was, -1 for none) [ns]; index: of the last
# tick granted; passed: of the last instant counted as missed; catch_up: most ticks of a burst.
GRID = np.dtype([
    ('period', np.float64), ('origin', np.int64), ('released', np.int64), ('index', np.int64),
    ('passed', np.int64), ('ticks', np.int64), ('missed', np.int64), ('slipped', np.int64),
    ('catch_up', np.int64), ('halts', np.int64), ('halted', np.int64)], align=True)


def next_instant(grid, now):
    """Return (index, instant [ns]) of the next tick, with what was missed counted; see halted."""
    g = grid[0]
    origin, period, index = g['origin'], g['period'], g['index'] + 1
    instant = origin + round(index * period)
    if now <= instant:
        return index, instant
    behind = math.ceil((now - instant) / period)
    # Instants are whole nanoseconds, so the quotient may be one off.
    if origin + round((index + behind) * period) < now:
        behind += 1
    elif behind > 1 and origin + round((index + behind - 1) * period) >= now:
        behind -= 1
    passed = index + behind - 1
    g['missed'] += max(0, passed - max(g['passed'], index - 1))
    g['passed'] = max(g['passed'], passed)
    if g['halts'] == 1:
        g['halted'] = 1
        return index, instant
    slip = max(0, behind - g['catch_up'])
    g['slipped'] += slip
    index += slip
    return index, origin + round(index * period)


def release(grid, index, now):
    """Grant the tick of that index now [ns]."""
    g = grid[0]
    g['index'], g['released'] = index, now
    g['ticks'] += 1
