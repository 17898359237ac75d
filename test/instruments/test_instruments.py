# SPDX-License-Identifier: Apache-2.0
"""The sensors: what a reading is of the truth, and that it does not depend on who reads."""

from hydra_actuator.channels import Channels
import numpy as np
import pytest

TICKS = 4000
STEPS = 10
NOISES = {'position_noise': 1e-5, 'velocity_noise': 2e-3, 'pressure_noise': 3e4}


def test_without_a_sensor_model_the_row_is_the_row(make):
    bench = make()
    row = bench.row(20)
    assert bench.instruments.read(row) is row
    assert not bench.instruments.acting
    assert bench.instruments.variance == 0.0


def test_noise_has_its_standard_deviation_and_no_bias(make):
    # Fixed seed, fixed numbers; the limits are four standard errors.
    bench = make(**NOISES)
    truth, readings = bench.rows(TICKS)
    noise = readings - truth
    channels = bench.channels
    for columns, deviation in (
            (channels.POSITION, 1e-5), (channels.VELOCITY, 2e-3), (channels.pressure, 3e4)):
        values = noise[:, columns].reshape(TICKS, -1)
        assert np.abs(values.mean(axis=0)).max() < 4.0 * deviation / np.sqrt(TICKS)
        assert values.std(axis=0) == pytest.approx(deviation, rel=4.0 / np.sqrt(2.0 * TICKS))


def test_only_what_a_sensor_measures_is_touched(make):
    bench = make(**NOISES)
    truth, readings = bench.rows(5)
    changed = np.flatnonzero((truth != readings).any(axis=0)).tolist()
    channels = bench.channels
    pressures = list(range(channels.pressure.start, channels.pressure.stop))
    assert changed == [channels.POSITION, channels.VELOCITY, *pressures]


def test_noise_is_that_of_the_seed_and_of_the_instant(make):
    _, readings = make(**NOISES).rows(50)
    _, again = make(**NOISES).rows(50)
    _, other = make(**NOISES, seed=1).rows(50)
    assert readings.tolist() == again.tolist()
    assert not (readings == other)[:, Channels.POSITION].any()
    _, late = make(**NOISES).rows(20, first=30)
    assert late.tolist() == readings[30:].tolist()


def test_readings_between_the_ticks_leave_those_at_the_ticks_as_they_are(make):
    options = {**NOISES, 'delay': 2.5e-3, 'position_resolution': 0.5}
    sparse, dense = make(**options), make(**options)
    at_ticks = [sparse.read(step) for step in range(0, 20 * STEPS, STEPS)]
    everywhere = [dense.read(step) for step in range(20 * STEPS)]
    assert everywhere[::STEPS] == at_ticks


def test_an_earlier_time_is_a_new_beginning(make):
    bench = make(**NOISES, delay=3e-3)
    _, first = bench.rows(10)
    _, second = bench.rows(10)
    assert first.tolist() == second.tolist()


@pytest.mark.parametrize('ticks', [1, 7, 250])
def test_a_delay_is_exact_to_the_tick(make, ticks):
    bench = make(delay=ticks * 1e-3)
    truth, readings = bench.rows(ticks + 20)
    columns = list(bench.instruments._columns)
    assert readings[ticks:, columns].tolist() == truth[:-ticks, columns].tolist()
    assert (readings[:ticks, columns] == truth[0, columns]).all()
    assert readings[:, Channels.TIME].tolist() == truth[:, Channels.TIME].tolist()


def test_a_delay_of_part_of_a_tick_lies_between_two(make):
    truth, readings = make(delay=2.5e-3).rows(20)
    expected = 0.5 * (truth[1:17] + truth[2:18])
    assert readings[4:, Channels.VELOCITY] == pytest.approx(expected[:, Channels.VELOCITY])


def test_the_true_flow_and_the_load_are_never_touched(make):
    bench = make(**NOISES, delay=5e-3)
    truth, readings = bench.rows(10)
    channels = bench.channels
    for columns in (channels.flow_velocity, channels.LOAD_FORCE, channels.cavities):
        assert readings[:, columns].tolist() == truth[:, columns].tolist()


def test_a_resolution_leaves_whole_steps_and_half_of_one_at_most(make):
    bench = make(position_noise=0.3, position_resolution=0.25, pressure_resolution=7.0)
    truth, readings = bench.rows(500)
    steps = readings[:, Channels.POSITION] / 0.25
    assert (steps == np.round(steps)).all()
    pressures = readings[:, bench.channels.pressure]
    assert (np.round(pressures / 7.0) * 7.0 == pressures).all()
    assert np.abs(pressures - truth[:, bench.channels.pressure]).max() == 3.0
    assert readings[:, Channels.VELOCITY].tolist() == truth[:, Channels.VELOCITY].tolist()


def test_the_variance_is_that_of_the_noise_and_of_a_step(make):
    assert make(pressure_noise=3e4).instruments.variance == 9e8
    assert make(pressure_resolution=12.0).instruments.variance == pytest.approx(12.0)


def test_both_spools_are_read_each_for_itself_and_one_spool_for_both(make):
    _, one = make(delay=2e-3).rows(9)
    assert one[:, Channels.SPOOL_1].tolist() == one[:, Channels.SPOOL_2].tolist()
    truth, two = make(delay=2e-3, spools=2).rows(9)
    assert two[2:, Channels.SPOOL_2].tolist() == truth[:-2, Channels.SPOOL_2].tolist()
