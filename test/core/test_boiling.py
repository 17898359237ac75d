# SPDX-License-Identifier: Apache-2.0
"""Where the oil boils: volumes, and cavities that open, collapse, merge and part."""

from hydra_actuator.channels import Channels
from hydra_actuator.core.advance import advance
from hydra_actuator.core.boiling import CLOSES, count_cavities, gas_volumes, OPENS
from hydra_actuator.core.cavity import share_face_gas
from hydra_actuator.core.model import Domain, Junction, Mesh
from hydra_actuator.core.observe import observe, SECTION
from hydra_actuator.core.oil import Oil
from hydra_actuator.core.records import CLOSED, PISTON, PISTON_PARAMETERS, PRESSURE
from hydra_actuator.verification.cavitation import close_valve, slammed_line
from hydra_actuator.verification.chains import DENSITY, LoneChain, WAVE_SPEED
import numpy as np
import pytest

AMBIENT, FLOOR = 101325.0, 101315.0
AIR, AREA, LENGTH = 1e-4, 2e-4, 2.0
OPENED, HELD_OPEN, SHUT = 0.5 * OPENS * FLOOR, 0.5 * (OPENS + CLOSES) * FLOOR, FLOOR


@pytest.fixture
def line() -> LoneChain:
    """Return a line of 20 cells with gas, at ambient pressure."""
    return LoneChain(
        [Domain('line', LENGTH, AREA, WAVE_SPEED)],
        [Junction(PRESSURE, (0,), 0), Junction(CLOSED, (1,))],
        Mesh(LENGTH / 20 / (1.025 * WAVE_SPEED)), Oil(DENSITY, 0.0, AIR, FLOOR))


@pytest.fixture
def cylinder() -> LoneChain:
    """Return two chambers with gas and a piston between."""
    piston = np.zeros(1, PISTON_PARAMETERS)
    piston['mass'], piston['limit'] = 1.0, 0.05
    piston['length_1'] = piston['length_2'] = 0.33
    chambers = [Domain(f'chamber_{k + 1}', 0.33, AREA, WAVE_SPEED, longest=0.4,
                       direction=1.0 - 2.0 * k) for k in range(2)]
    return LoneChain(
        chambers, [Junction(CLOSED, (0,)), Junction(CLOSED, (2,)), Junction(PISTON, (1, 3), 0)],
        Mesh(LENGTH / 200 / (1.025 * WAVE_SPEED)), Oil(DENSITY, 0.0, AIR, FLOOR), piston=piston)


def row_of(chain: LoneChain) -> tuple[np.ndarray, Channels]:
    """Return an observation row of a chain without sections."""
    channels = Channels((), domains=tuple(chain.names))
    row = channels.empty_row()
    observe(chain.model, chain.state, np.zeros(0, SECTION), AMBIENT, chain.inputs, row)
    return row, channels


def show(chain: LoneChain, now: dict, since: tuple = ()) -> tuple[int, int, int]:
    """
    Count with p* of some nodes as given and others at ambient pressure; return the counts.

    since: nodes that have boiled since the last count.
    """
    first = chain.model.start[0]
    star = np.full(chain.state.last[0] + 1, SHUT)
    for node, value in now.items():
        star[node] = value
    chain.state.star[first:first + len(star)] = star
    chain.state.end_star[:2] = star[[0, -1]]
    lowest = star.copy()
    lowest[list(since)] = OPENED
    chain.state.lowest_star[first:first + len(star)] = lowest
    count_cavities(chain.model, chain.state)
    counts = chain.state.cavities[0]
    return int(counts['open']), int(counts['opened']), int(counts['collapsed'])


def test_places_side_by_side_are_one_cavity_and_apart_are_two(line):
    assert show(line, {3: OPENED, 4: OPENED, 5: OPENED}) == (1, 1, 0)
    assert show(line, {4: OPENED, 9: OPENED}) == (2, 2, 0)
    assert show(line, {}) == (0, 2, 2)


def test_a_cavity_between_two_counts_has_opened_and_collapsed(line):
    assert show(line, {}, since=(7, 8)) == (0, 1, 1)
    assert show(line, {}) == (0, 1, 1)


def test_what_merges_has_collapsed_and_what_parts_has_opened(line):
    show(line, {3: OPENED, 6: OPENED})
    assert show(line, dict.fromkeys(range(3, 7), OPENED)) == (1, 2, 1)
    assert show(line, {3: OPENED, 6: OPENED}) == (2, 3, 1)


def test_a_cavity_stays_until_it_is_well_above_where_it_opened(line):
    assert show(line, {10: HELD_OPEN}) == (0, 0, 0)
    assert show(line, {10: OPENED}) == (1, 1, 0)
    for _ in range(5):
        assert show(line, {10: HELD_OPEN}) == (1, 1, 0)
        assert show(line, {10: OPENED}) == (1, 1, 0)
    assert show(line, {10: 1.01 * CLOSES * FLOOR}) == (0, 1, 1)


def test_both_ends_count(line):
    assert show(line, {0: OPENED, 20: OPENED}) == (2, 2, 0)


def test_open_is_what_opened_less_what_collapsed_whatever_happens(line):
    random = np.random.default_rng(3)
    for _ in range(300):
        nodes = np.flatnonzero(random.random(21) < 0.3)
        values = random.choice([OPENED, HELD_OPEN], len(nodes))
        since = np.flatnonzero(random.random(21) < 0.1)
        count, opened, collapsed = show(line, dict(zip(nodes, values)), tuple(since))
        assert count == opened - collapsed
    assert opened > 300


def test_the_volume_is_the_gas_beyond_what_it_takes_at_ambient_pressure(line):
    spacing = float(line.model.spacing[0])
    gas_at_ambient = AIR * AREA * spacing
    show(line, {0: 0.01 * FLOOR, 5: 0.1 * FLOOR, 6: 10.0 * FLOOR})
    row, channels = row_of(line)
    assert row[channels.cavity_volume] == pytest.approx(gas_at_ambient * (0.5 * 99 + 9), rel=1e-12)
    assert row[channels.lowest_pressure] == pytest.approx(AMBIENT - 0.99 * FLOOR, rel=1e-12)
    gas = gas_volumes(line.model, line.state, 0)
    assert gas[[0, 5, 6, 7]] == pytest.approx(gas_at_ambient * np.array([50, 10, 0.1, 1]))
    assert gas.sum() == pytest.approx(gas_at_ambient * (50 + 10 + 0.1 + 17.5))


def test_a_slammed_line_reports_the_gas_that_is_in_it():
    chain = slammed_line(100, 0.975)
    largest = 0.0
    while chain.time < 0.012:
        close_valve(chain)
        row, channels = row_of(chain)
        gas = gas_volumes(chain.model, chain.state, 0)
        # what is above ambient pressure is compressed, so the gas is at most that more
        at_ambient = 1e-7 * AREA * LENGTH
        assert 0.0 <= row[channels.cavity_volume] - gas.sum() + at_ambient <= at_ambient
        assert row[channels.domain_cavities] == row[channels.cavity_volume]
        largest = max(largest, row[channels.cavity_volume])
    assert largest > 1000.0 * at_ambient


def test_cavities_of_a_pulled_cylinder_open_in_its_chamber_and_collapse(cylinder):
    rows = []
    for pull in (0.0, -2000.0, 0.0, 0.0):
        for _ in range(100):
            cylinder.hold(pull)
            run(cylinder, 10)
            rows.append(row_of(cylinder)[0])
    rows, channels = np.array(rows), row_of(cylinder)[1]
    volume, count = rows[:, channels.domain_cavities], rows[:, channels.cavities_open]
    assert count[:100].max() == 0
    assert count[100:200].max() >= 1
    assert volume[100:200, 0].max() > 100.0 * AIR * AREA * 0.01
    assert volume[:200, 1].max() < 1e-6 * volume[100:200, 0].max()
    assert (count == rows[:, channels.cavities_opened]
            - rows[:, channels.cavities_collapsed]).all()
    assert rows[-1, channels.cavities_collapsed] >= 1


def run(chain: LoneChain, interval: int, splits: int = 1) -> None:
    """Advance by an interval under the held inputs and count at its end, in so many calls."""
    for _ in range(splits):
        assert advance(chain.model, chain.state, (0, 0), (np.zeros(1), chain._table, True),
                       chain.inputs, interval // splits, interval) == 0


def test_counts_do_not_depend_on_how_steps_are_split():
    counts = []
    for splits in (1, 5):
        chain = slammed_line(50, 0.975)
        chain.hold(0.5e6, 0.0)
        for _ in range(40):
            run(chain, 10, splits)
        counts.append(chain.state.cavities[0].copy())
    assert counts[0] == counts[1]
    assert counts[0]['opened'] > 1


def test_without_gas_there_are_no_cavities_but_a_lowest_pressure():
    chain = LoneChain(
        [Domain('line', LENGTH, AREA, WAVE_SPEED, pressure=2e5)],
        [Junction(PRESSURE, (0,), 0), Junction(CLOSED, (1,))],
        Mesh(LENGTH / 50 / (1.025 * WAVE_SPEED)))
    chain.hold(-5e5)
    chain.advance(37)
    row, channels = row_of(chain)
    assert row[channels.lowest_pressure] == pytest.approx(
        chain.pressure(0).min() + AMBIENT, rel=1e-12)
    assert row[channels.lowest_pressure] < -3e5
    others = np.delete(row[channels.cavities], 1)
    assert not others.any()


def test_gas_between_face_and_last_node_keeps_its_volume_when_a_node_comes_or_goes(cylinder):
    model, state = cylinder.model, cylinder.state
    cylinder.hold(-2000.0)
    cylinder.advance(60)
    for change in (1, -1):
        before = int(state.last[0])
        volume = gas_volumes(model, state, 0).sum()
        state.last[0] = before + change
        state.old_length[0] = (state.last[0] + 0.3) * model.spacing[0]
        share_face_gas(model, state, 0, before)
        assert gas_volumes(model, state, 0).sum() == pytest.approx(volume, rel=1e-12)
        inner = slice(model.start[0] + 1, model.start[0] + state.last[0])
        assert (state.strength[inner] > 0.0).all()
        assert state.strength[inner.stop] == 0.0
