# SPDX-License-Identifier: Apache-2.0
"""The actuator as a whole: rest, reproducibility, limits, commands, what can be read from it."""

import math

from hydra_actuator.actuator import Actuator, SolverError
from hydra_actuator.channels import Channels, DOMAINS, STATIONS
from hydra_actuator.core.observe import NOT_A_NUMBER, TOO_FAST
from hydra_actuator.parameters import ParameterError, Parameters
from hydra_actuator.tally import Cavities
import numpy as np
import pytest

# Rounding of mu = 9 m/s leaves 1e-15 of it, 1e-9 Pa, in each of the 26e6 node updates per second;
# the lines carry it back and forth without adding it up.
REST_PRESSURE, REST_VELOCITY, REST_POSITION = 1e-5, 1e-11, 1e-14
BALANCED = {
    'paper': {'tank.pressure': 0.0},
    'tank at 2.5 MPa': {},
    'unequal areas': {
        'cylinder.area_2': 0.0007, 'initial.pressure_1': 7e6, 'initial.pressure_2': 1e7,
        'cylinder.stiffness': 0.0, 'initial.position': 0.0137},
    'held by the spring': {
        'initial.pressure_1': 12e6, 'initial.pressure_2': 11e6, 'initial.position': 0.005},
}


def make(**changes) -> Actuator:
    """Return an actuator; dots of the names are written as two underscores."""
    return Actuator(Parameters().replace(
        {name.replace('__', '.'): value for name, value in changes.items()}))


def largest_departure(actuator: Actuator, periods: int) -> np.ndarray:
    """Return how far each channel strays from the initial row while nothing is commanded."""
    start = None
    worst = np.zeros(actuator.channels.width)
    for _ in range(periods):
        assert actuator.tick_once(0.0, 0.0, 0.0) == 0
        start = actuator.row.copy() if start is None else start
        worst = np.maximum(worst, np.abs(actuator.row - start))
    return worst


def assert_at_rest(actuator: Actuator, periods: int) -> None:
    channels, worst = actuator.channels, largest_departure(actuator, periods)
    assert worst[channels.POSITION] < REST_POSITION
    assert worst[channels.VELOCITY] < REST_VELOCITY
    assert worst[channels.pressure].max() < REST_PRESSURE
    assert worst[channels.flow_velocity].max() < REST_VELOCITY


@pytest.mark.parametrize('changes', BALANCED.values(), ids=BALANCED)
def test_closed_valve_and_balanced_piston_stay_at_rest(changes):
    assert_at_rest(Actuator(Parameters().replace(changes)), 1000)


@pytest.mark.soak
def test_rest_lasts_a_minute():
    assert_at_rest(make(), 60_000)


@pytest.mark.parametrize('leakage', [0.0, 1e-12])
def test_underlapped_valve_starts_from_rest_and_settles(leakage):
    actuator = make(valve__leakage=leakage, tank__pressure=0.0, **{
        f'valve__overlap_{edge}': -2e-5 for edge in ('pa', 'pb', 'at', 'bt')})
    state = actuator.advance(0.3)
    # half of the edges' area on each side of equal chambers: the piston stays by symmetry
    assert state.position == pytest.approx(0.0, abs=1e-12)
    across = 0.62 * 0.03 * 2e-5 * math.sqrt(2.0 * 10.5e6 / 860.0) + leakage * 10.5e6
    area = math.pi / 4.0 * 0.016 ** 2
    ratio = 1.0 + 21e6 / 1.4534e9
    assert state.flow_velocity['A'] * area * ratio == pytest.approx(2.0 * across, rel=1e-3)


def test_unbalanced_piston_does_not_rest():
    worst = largest_departure(make(initial__pressure_1=10.6e6), 100)
    assert worst[Channels.POSITION] > 1e-6


def commands_until(actuator: Actuator, steps: int) -> tuple[np.ndarray, np.ndarray, bool]:
    times = np.arange(1, steps + 1) * actuator.step_time
    sine = 0.8 * np.sin(2.0 * math.pi * 50.0 * times)
    return times, np.column_stack((sine, 0.9 * sine, 1e3 * sine)), True


@pytest.mark.parametrize('iterations', [1, 2, 3])
def test_any_split_of_the_steps_gives_the_same_bits(iterations):
    whole, parts = (make(solver__iterations=iterations, valve__spools=2) for _ in range(2))
    steps = 20 * whole.steps_per_period
    schedule = commands_until(whole, steps)
    assert whole.follow(schedule, steps) == 0
    rng, done = np.random.default_rng(3), 0
    while done < steps:
        part = min(steps - done, int(rng.integers(1, 200)))
        assert parts.follow(schedule, part) == 0
        done += part
    assert parts.row.tobytes() == whole.row.tobytes()
    assert field_of(parts).tobytes() == field_of(whole).tobytes()


@pytest.mark.parametrize('cells', [30, 50, 60, 70])
def test_few_cells_stay_calm_after_the_valve_has_closed(cells):
    actuator = Actuator(Parameters().replace({'solver.cells': cells}))
    actuator.advance(0.1, spool=0.2)
    state = actuator.advance(0.4, spool=0.0)
    # lines and chambers of three to seven cells once rang up to the limit of the method here
    assert abs(state.velocity) < 1.0
    assert max(abs(u) for u in state.flow_velocity.values()) < 2.0


def test_replay_after_reset_gives_the_same_bits():
    actuator = make(valve__natural_frequency=200.0, cylinder__coulomb_friction=50.0,
                    cylinder__static_friction=80.0, supply__accumulator_volume=1e-3)
    runs = []
    for _ in range(2):
        rows = []
        for k in range(30):
            spool = math.sin(0.3 * k)
            assert actuator.tick_once(spool, spool, 100.0 * k) == 0
            rows.append(actuator.row.copy())
        runs.append(np.array(rows).tobytes() + field_of(actuator).tobytes())
        actuator.reset()
    assert runs[0] == runs[1]


def test_reading_changes_nothing():
    silent, watched = make(), make()
    for _ in range(20):
        silent.tick_once(0.7, 0.7, 0.0)
        watched.tick_once(0.7, 0.7, 0.0)
        field_of(watched)
        assert watched.state
    assert silent.row.tobytes() == watched.row.tobytes()


def field_of(actuator: Actuator) -> np.ndarray:
    out = np.empty((len(actuator.field_labels), 2), np.float32)
    actuator.read_field(out)
    return out


@pytest.mark.parametrize('domain', range(6), ids=DOMAINS)
def test_a_single_nan_is_found_where_it_is(domain):
    actuator = make()
    model, state = actuator._model, actuator._state
    state.wave_p[model.start[domain] + state.last[domain] // 2] = math.nan
    code = actuator.follow((np.zeros(1), np.zeros((1, 3)), True), 0)
    assert code == NOT_A_NUMBER
    assert actuator.status_message(code) == f'NaN in {DOMAINS[domain]} at 0.000000 s'


@pytest.mark.parametrize('command', [(math.nan, 0.1, 0.0), (0.1, math.nan, 0.0),
                                     (0.1, 0.1, math.nan)])
def test_a_command_that_is_no_number_is_found_within_the_tick(command):
    actuator = make(cylinder__coulomb_friction=50.0, cylinder__static_friction=80.0)
    code = actuator.tick_once(*command)
    assert code == NOT_A_NUMBER
    assert actuator.status_message(code).startswith('NaN in ')


def test_oil_too_fast_for_the_mesh_is_named_with_its_limit():
    actuator = make(solver__max_mach=0.003)
    with pytest.raises(SolverError, match=r'\|u\|/c = 0\.00\d+ in \w+ at 0\.\d+ s exceeds '
                                          r'solver\.max_mach 0\.003'):
        actuator.advance(0.05, spool=1.0)
    assert actuator.follow((np.zeros(1), np.zeros((1, 3)), True), 0) == TOO_FAST


def test_line_shorter_than_a_cell_is_refused():
    with pytest.raises(ParameterError, match=r'line_1\.length = .* shorter than one cell'):
        make(line_1__length=0.001)


@pytest.mark.parametrize('bad', [
    {'spool': 1.5}, {'spool': math.nan}, {'spool': (0.0, 2.0)}, {'spool': (0.0, 0.0, 0.0)},
    {'load_force': math.inf}, {'duration': -1.0}, {'duration': math.nan},
])
def test_bad_command_is_refused_and_changes_nothing(bad):
    actuator = make()
    before = actuator.advance(0.002, spool=0.5)
    with pytest.raises(ValueError, match=next(iter(bad))):
        actuator.advance(**{'duration': 0.001, **bad})
    assert actuator.state == before


def test_advance_keeps_the_last_command():
    held, repeated = make(), make()
    held.advance(0.004, spool=0.5, load_force=100.0)
    repeated.advance(0.004, spool=0.5, load_force=100.0)
    assert held.advance(0.004) == repeated.advance(0.004, spool=0.5, load_force=100.0)


def test_state_names_all_sections_and_counts_time_in_steps():
    actuator = make()
    state = actuator.advance(0.0102, spool=0.3)
    assert tuple(state.pressure) == STATIONS == tuple(state.flow_velocity)
    assert state.time == actuator.time
    assert 0.0102 <= state.time < 0.0102 + actuator.step_time
    assert actuator.tick == 10
    assert state.spool_position == (pytest.approx(0.3 * 0.0005, rel=1e-15),)
    assert state.effort == pytest.approx(
        1e-3 * (state.pressure['E'] - state.pressure['F']), rel=1e-12)


def test_positive_spool_moves_the_piston_out_and_oil_from_pump_to_tank():
    state = make().advance(0.02, spool=0.3)
    assert state.position > 1e-3
    assert all(velocity > 0.0 for velocity in state.flow_velocity.values())
    assert make().advance(0.02, spool=-0.3).position < -1e-3


def test_mirrored_commands_mirror_the_piston():
    mirrored = {'tank__pressure': 0.0}
    there, back = (make(**mirrored).advance(0.03, spool=sign * 0.4) for sign in (1.0, -1.0))
    # 3.5e-12 um is what an independent solution gave
    assert there.position + back.position == pytest.approx(0.0, abs=1e-15)
    assert there.pressure['E'] == pytest.approx(back.pressure['F'], rel=1e-12)


def test_load_pushes_against_positive_motion():
    assert make().advance(0.02, load_force=1000.0).position < -1e-6


def test_two_spools_meter_independently():
    actuator = make(valve__spools=2)
    state = actuator.advance(0.01, spool=(0.5, 0.0))
    assert state.spool_position == (0.00025, 0.0)
    assert state.flow_velocity['B'] > 0.1
    assert state.flow_velocity['I'] == 0.0


def test_supply_pressure_is_live():
    actuator = make()
    actuator.set_supply_pressure(15e6)
    state = actuator.advance(0.001)
    assert state.pressure['O'] == pytest.approx(15e6 + 101325.0, rel=1e-12)
    actuator.reset()
    assert actuator.advance(0.001).pressure['O'] == pytest.approx(21e6 + 101325.0, rel=1e-12)


def test_piston_stops_at_the_end_of_its_stroke():
    actuator = make(cylinder__stiffness=0.0)
    state = actuator.advance(1.0, spool=1.0)
    assert state.position == 0.1
    assert state.velocity == 0.0
    assert actuator.tally.stop_hits == 1
    assert actuator.advance(0.2, spool=-1.0).position < 0.05


def test_schedule_is_linear_between_rows_or_held():
    linear, held = make(), make()
    rows = np.array([0.0, 0.004]), np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    steps = 2 * linear.steps_per_period
    linear.follow((*rows, False), steps)
    held.follow((*rows, True), steps)
    assert linear.row[Channels.SPOOL_1] == pytest.approx(0.5 * 0.0005, rel=1e-12)
    assert held.row[Channels.SPOOL_1] == 0.0
    held.follow((*rows, True), steps)
    assert held.row[Channels.SPOOL_1] == 0.0005


def test_sections_of_lines_read_the_polynomial_through_the_nodes():
    names = ('O', 'pump_side', 'mid_supply', 'J', 'tank_side')
    actuator = make(sections__names=names, sections__positions=(0.0, 0.3, 2.0))
    for _ in range(7):
        actuator.tick_once(0.8, 0.8, 0.0)
    state = actuator.state
    assert state.pressure['pump_side'] == pytest.approx(state.pressure['O'], rel=1e-12)
    field, places = field_of(actuator), actuator.field_positions
    supply = [k for k, label in enumerate(actuator.field_labels) if label == 'supply_line']
    expected = np.interp(0.3, places[supply], field[supply, 1])
    # linear between nodes 10 mm apart, of a wave of metres; float32
    assert state.flow_velocity['mid_supply'] == pytest.approx(expected, rel=1e-3)
    assert state.pressure['tank_side'] == pytest.approx(2.5e6 + 101325.0, rel=1e-9)


def test_section_in_the_stroke_reads_the_chamber_that_covers_it():
    middle = 1.0
    actuator = make(sections__names=('E', 'F', 'own'), sections__positions=(middle,),
                    initial__position=0.05, cylinder__stiffness=0.0)
    before = actuator.advance(0.001, spool=-1.0)
    assert before.pressure['own'] == pytest.approx(before.pressure['E'], rel=0.02)
    while actuator.state.position > -0.03:
        after = actuator.advance(0.001)
    assert abs(after.pressure['own'] - after.pressure['F']) < (
        0.2 * abs(after.pressure['E'] - after.pressure['F']))
    assert after.flow_velocity['own'] == pytest.approx(after.velocity, rel=0.1)


@pytest.mark.parametrize(('side', 'face'), [(-1.0, 'E'), (1.0, 'F')])
@pytest.mark.parametrize('position', [0.0, 0.003, -0.003])
def test_section_at_the_face_agrees_with_the_face_even_in_a_sharp_front(side, face, position):
    actuator = make(sections__names=('E', 'F', 'own'), initial__position=position,
                    sections__positions=(1.0 + position + side * 2e-5,))
    channels = actuator.channels
    pressures = []
    for _ in range(60):
        actuator.advance(actuator.step_time, spool=0.5)
        pressures.append(actuator.row[channels.pressure].copy())
    of_face = np.array(pressures)[:, 'EF'.index(face)]
    assert abs(actuator.state.position - position) < 2e-5
    assert np.ptp(of_face) > 1e5
    np.testing.assert_allclose(np.array(pressures)[:, 2], of_face, rtol=1e-3)


def test_section_off_the_streamline_is_refused():
    with pytest.raises(ParameterError, match=r'sections\.positions: 2\.5 m lies beyond'):
        make(sections__names=('own',), sections__positions=(2.5,))


def test_field_lies_in_streamline_order_and_agrees_with_the_stations():
    actuator = make(cylinder__stiffness=0.0)
    state = actuator.advance(0.05, spool=0.6)
    field, labels = field_of(actuator), actuator.field_labels
    places = actuator.field_positions
    assert len(labels) == len(places) == len(field)
    assert [label for k, label in enumerate(labels) if k == 0 or labels[k - 1] != label] == (
        list(DOMAINS))
    for first, last, domain in zip('OBDFHJ', 'ACEGIK', DOMAINS):
        rows = [k for k, label in enumerate(labels) if label == domain]
        assert field[rows[0], 0] == pytest.approx(state.pressure[first], rel=1e-6)
        assert field[rows[-1], 0] == pytest.approx(state.pressure[last], rel=1e-6)
        assert field[rows[-1], 1] == pytest.approx(state.flow_velocity[last], rel=1e-5)
        if domain.endswith(('line', '1', '2')) and not domain.startswith('chamber'):
            assert (np.diff(places[rows]) > 0.0).all()
            assert np.isfinite(field[rows]).all()


def test_field_is_nan_exactly_where_a_chamber_does_not_reach():
    actuator = make(cylinder__stiffness=0.0)
    state = actuator.advance(0.05, spool=0.6)
    assert state.position > 0.02
    field, places = field_of(actuator), actuator.field_positions
    face = 1.0 + state.position
    for name, side in (('chamber_1', -1.0), ('chamber_2', 1.0)):
        rows = [k for k, label in enumerate(actuator.field_labels) if label == name]
        nodes = rows[:-1] if name == 'chamber_1' else rows[1:]
        covered = side * (places[nodes] - face) >= 0.0
        assert (np.isfinite(field[nodes, 0]) == covered).all()
        assert not covered.all()


@pytest.mark.parametrize('cells', [60, 137, 200, 333])
def test_period_is_a_whole_number_of_steps(cells):
    actuator = make(solver__cells=cells)
    assert actuator.steps_per_period * actuator.step_time == pytest.approx(
        actuator.period, rel=1e-14)
    assert actuator.step_time <= 2.0 / (cells * 1300.0)


def boiling(**changes) -> Actuator:
    """Return an actuator whose return line tears at a full-stroke sine."""
    return make(tank__pressure=0.0, solver__cells=100, fluid__cavitation=True, **changes)


def sine(actuator: Actuator, ticks: int) -> np.ndarray:
    """Return the rows of ticks of a full-stroke sine of 50 Hz."""
    rows = []
    for k in range(ticks):
        spool = math.sin(0.1 * math.pi * k)
        assert actuator.tick_once(spool, spool, 0.0) == 0
        rows.append(actuator.row.copy())
    return np.array(rows)


def test_oil_that_boils_is_seen_in_row_state_and_counts():
    actuator = boiling()
    rows, columns = sine(actuator, 60), actuator.channels
    counts = actuator.tally.cavities
    assert counts.opened >= 1
    assert counts.open == counts.opened - counts.collapsed == rows[-1, columns.cavities_open]
    assert counts.largest == rows[:, columns.cavity_volume].max() > 1e-7
    assert rows[:, columns.lowest_pressure].min() > 10.0
    volumes = rows[:, columns.domain_cavities]
    assert volumes.sum(axis=1) == pytest.approx(rows[:, columns.cavity_volume], rel=1e-12)
    assert volumes[:, DOMAINS.index('return_line')].max() > 1e-7
    state = actuator.state
    assert state.cavity_volume == rows[-1, columns.cavity_volume]
    assert state.void_fraction['O'] == pytest.approx(
        1e-4 * (101325.0 - 10.0) / (state.pressure['O'] - 10.0))
    assert max(state.void_fraction, key=state.void_fraction.get) == min(
        state.pressure, key=state.pressure.get)
    assert actuator.tally.vacuum_ticks == 0


def test_counts_of_cavities_start_anew_with_a_reset():
    actuator = boiling()
    first = sine(actuator, 30)
    actuator.reset()
    assert actuator.tally.cavities == Cavities(0, 0, 0, 0.0)
    assert np.array_equal(sine(actuator, 30), first)


def test_sections_at_the_piston_move_with_it_where_there_is_gas():
    actuator = boiling()
    rows, columns = sine(actuator, 30), actuator.channels
    faces = rows[:, columns.flow_velocity][:, [STATIONS.index('E'), STATIONS.index('F')]]
    assert np.array_equal(faces, np.repeat(rows[:, [columns.VELOCITY]], 2, axis=1))
    field = np.empty((len(actuator.field_labels), 2), np.float32)
    actuator.read_field(field)
    face = actuator.field_labels.index('chamber_2')
    assert field[face, 1] == np.float32(rows[-1, columns.VELOCITY])


def test_without_gas_ticks_below_vacuum_are_counted():
    actuator = make(tank__pressure=0.0, solver__cells=100)
    rows, columns = sine(actuator, 40), actuator.channels
    below = rows[:, columns.lowest_pressure] < 0.0
    assert actuator.tally.vacuum_ticks == below.sum() > 5
    assert actuator.tally.cavities == Cavities(0, 0, 0, 0.0)
    assert set(actuator.state.void_fraction.values()) == {0.0}
    assert (rows[:, columns.lowest_pressure]
            <= rows[:, columns.pressure].min(axis=1) + REST_PRESSURE).all()
