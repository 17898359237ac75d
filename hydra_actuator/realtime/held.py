# SPDX-License-Identifier: Apache-2.0
"""
The command that holds, as it lies between the thread that receives and the one that solves.

A spool command is put into a slot that nobody reads, then its number into `slot`: a reader meets
the old or the new one, never half of each. A load is one number, and needs no slots.
"""

from typing import NamedTuple

import numpy as np

SLOTS = 4
SLOT = np.dtype(
    [('spool_1', np.float64), ('spool_2', np.float64), ('accepted', np.int64)], align=True)
# Of those who command: slot, given (commands and loads so far), load_force [N], timeout [ns] (0:
# none), centres (whether silence centres the valve). Of the reader: the rest.
HELD = np.dtype([
    ('slot', np.int64), ('given', np.int64), ('load_force', np.float64), ('timeout', np.int64),
    ('centres', np.int64), ('taken', np.int64), ('applied', np.int64), ('timed_out', np.int64),
    ('timeouts', np.int64), ('sampled_1', np.float64), ('sampled_2', np.float64),
    ('sampled_load', np.float64)], align=True)


class Held(NamedTuple):
    """Slots (SLOTS,) of SLOT, and one HELD (1,)."""

    slots: np.ndarray
    record: np.ndarray


def nothing_held() -> Held:
    """Return memory in which the valve is centred, without a load."""
    return Held(np.zeros(SLOTS, SLOT), np.zeros(1, HELD))


def sample(held, now):
    """Return (spool 1, spool 2, load [N]) as they hold at an instant [ns]; for the reader."""
    record = held.record[0]
    given = record['given']
    if given != record['taken']:
        record['taken'] = given
        record['applied'] += 1
    slot = held.slots[record['slot']]
    spool_1, spool_2, load_force = slot['spool_1'], slot['spool_2'], record['load_force']
    silent = 0
    if record['timeout'] > 0 and now - slot['accepted'] > record['timeout']:
        silent = 1
        if record['timed_out'] == 0:
            record['timeouts'] += 1
        if record['centres'] == 1:
            spool_1, spool_2 = 0.0, 0.0
    record['timed_out'] = silent
    record['sampled_1'], record['sampled_2'] = spool_1, spool_2
    record['sampled_load'] = load_force
    return spool_1, spool_2, load_force
