# SPDX-License-Identifier: Apache-2.0
"""Random parameters and violent commands: all run soundly or are refused with a reason."""

from campaign.commands import draw_sequence
from campaign.draw import draw_set, physical
from campaign.outcome import FAILED, Outcome, outcome_of, RAN, REFUSED, STOPPED
from campaign.record import carry_out, read, summary
import numpy as np
import pytest

SETS, SEQUENCES = 10_000, 200
SAMPLE_SETS, SAMPLE_SEQUENCES = 50, 12
# Sets that once failed, with the budget they failed at.
ONCE_FAILED, THEIR_BUDGET = (
    30, 42, 87, 140, 581, 1952, 2316, 2537, 3205, 3253, 3282, 3397, 6830), 1.5e5
# Node updates: 0.2 s of the shipped actuator at 140 cells, and at 200.
SET_BUDGET, SAMPLE_BUDGET, SEQUENCE_BUDGET = 3e6, 3e5, 1e7
FULL_CELLS, SAMPLE_CELLS = 200, 40


def become(number: int, any_passes: bool, budget: float) -> Outcome:
    random = np.random.default_rng(number)
    return outcome_of(draw_set(number, any_passes), random, budget)


def follow(number: int, cells: int, budget: float) -> Outcome:
    return outcome_of(*draw_sequence(number, cells), budget)


def failures(outcomes: dict[int, Outcome]) -> dict[int, str]:
    return {k: o.message for k, o in outcomes.items() if o.kind == FAILED}


def test_a_sample_of_sets_runs_or_is_refused():
    outcomes = {k: become(k, False, SAMPLE_BUDGET) for k in range(SAMPLE_SETS)}
    print(summary(outcomes.values()))
    assert not failures(outcomes)
    kinds = [outcome.kind for outcome in outcomes.values()]
    assert kinds.count(RAN) > 10 and kinds.count(REFUSED) > 5


def test_sets_that_once_failed_do_not():
    assert not failures({k: become(k, False, THEIR_BUDGET) for k in ONCE_FAILED})


def test_a_sample_of_sequences_runs():
    outcomes = {k: follow(k, SAMPLE_CELLS, SEQUENCE_BUDGET) for k in range(SAMPLE_SEQUENCES)}
    print(summary(outcomes.values()))
    assert {outcome.kind for outcome in outcomes.values()} == {RAN}
    assert min(outcome.share for outcome in outcomes.values()) >= 1.0


def test_a_set_depends_on_its_number_alone_and_lies_in_the_ranges():
    table = {one.name: one for one in physical()}
    for number in range(300):
        values = draw_set(number, True)
        assert values == draw_set(number, True)
        assert values.keys() == table.keys()
        for name, value in values.items():
            assert table[name].check(value) == value


def test_a_record_is_taken_up_where_it_ended(tmp_path, monkeypatch):
    monkeypatch.setattr('campaign.record.place', lambda name: tmp_path / name)
    asked = []

    def one(number):
        asked.append(number)
        if number == 3 and len(asked) < 5:
            raise KeyboardInterrupt
        return Outcome(STOPPED if number else RAN, 'reason', 'message', 0.5)

    with pytest.raises(KeyboardInterrupt):
        carry_out('trial', 6, one, print)
    with (tmp_path / 'trial').open('a') as file:
        file.write('{"number": 3, "ki')
    outcomes = carry_out('trial', 6, one, print)
    assert asked == [0, 1, 2, 3, 3, 4, 5]
    assert outcomes == read(tmp_path / 'trial')
    assert summary(outcomes.values()).splitlines()[1] == '     5 stopped: reason'


@pytest.mark.soak
def test_all_sets_run_or_are_refused(capsys):
    outcomes = campaign('sets', SETS, lambda k: become(k, True, SET_BUDGET), capsys)
    assert not failures(outcomes)


@pytest.mark.soak
def test_all_sequences_run(capsys):
    outcomes = campaign(
        'sequences', SEQUENCES, lambda k: follow(k, FULL_CELLS, SEQUENCE_BUDGET), capsys)
    assert {outcome.kind for outcome in outcomes.values()} == {RAN}


def campaign(name, count, one, capsys) -> dict[int, Outcome]:
    """Carry out a campaign and print its counts past pytest's capture."""
    with capsys.disabled():
        outcomes = carry_out(name, count, one, lambda line: print(line, flush=True))
        print(summary(outcomes.values()))
    return outcomes
