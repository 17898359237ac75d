# SPDX-License-Identifier: Apache-2.0
"""The journal: whole lines survive whatever happens, one process writes."""

import math

from hydra_actuator.errors import InputError
from hydra_actuator.sweep.journal import FILE, finished, Journal, read_journal
from hydra_actuator.sweep.run import DONE, Outcome, STOPPED
import pytest

GOOD = Outcome(0, DONE, '', {'travel': 0.1, 'bandwidth': math.nan})
BAD = Outcome(1, STOPPED, 'too fast', {})


def test_outcomes_come_back_nan_included(tmp_path):
    with Journal(tmp_path) as journal:
        journal.append(GOOD)
        journal.append(BAD)
    found = read_journal(tmp_path)
    assert found[1] == BAD
    assert found[0].figures['travel'] == 0.1
    assert math.isnan(found[0].figures['bandwidth'])
    assert finished(found) == {0, 1}
    assert finished(found, with_failed=False) == {0}


def test_a_torn_line_is_dropped_and_writing_goes_on(tmp_path):
    with Journal(tmp_path) as journal:
        journal.append(GOOD)
        journal.append(BAD)
    path = tmp_path / FILE
    path.write_bytes(path.read_bytes()[:-5])
    assert set(read_journal(tmp_path)) == {0}
    with Journal(tmp_path) as journal:
        journal.append(BAD)
    assert set(read_journal(tmp_path)) == {0, 1}


def test_one_process_writes_at_a_time(tmp_path):
    with Journal(tmp_path), pytest.raises(InputError, match='another process runs the sweep'):
        Journal(tmp_path)


def test_damage_is_named_by_its_line(tmp_path):
    (tmp_path / FILE).write_text('[0, "done", "", {}]\nrubbish\n')
    with pytest.raises(InputError, match='line 2 is damaged'):
        read_journal(tmp_path)
