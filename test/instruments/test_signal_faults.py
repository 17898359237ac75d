# SPDX-License-Identifier: Apache-2.0
"""Each kind of fault on each quantity, on that quantity alone."""

import math

import numpy as np
import pytest

QUANTITIES = ('position', 'velocity', 'effort', 'spool', 'pressure.B')
TICKS, PERIOD = 400, 1e-3
BEFORE = 5


def run(make, quantity, kind, value, ticks=TICKS, spools=1):
    """Return (truth, readings) of the signals of a quantity, the fault from tick 5 on."""
    bench = make(spools=spools, remember=True)
    signals = bench.instruments._signals
    own = [column for column, name in zip(signals.columns, signals.quantities)
           if name == quantity]
    truth, readings = bench.rows(BEFORE)
    bench.set({f'fault.{quantity}.{kind}': value}, remember=True)
    more_truth, more = bench.rows(ticks, first=BEFORE)
    truth, readings = np.vstack([truth, more_truth]), np.vstack([readings, more])
    others = [k for k in range(bench.channels.width)
              if k not in own and not (own == [bench.channels.SPOOL_1] and k == own[0] + 1)]
    assert readings[:, others].tolist() == truth[:, others].tolist()
    assert readings[:BEFORE].tolist() == truth[:BEFORE].tolist()
    return truth[:, own], readings[:, own]


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_off_reads_nan(make, quantity):
    _, readings = run(make, quantity, 'off', True, 10)
    assert np.isnan(readings[BEFORE:]).all()


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_stuck_keeps_the_last_reading(make, quantity):
    truth, readings = run(make, quantity, 'stuck', True, 10)
    assert (readings[BEFORE:] == truth[BEFORE - 1]).all()


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_offset_is_added(make, quantity):
    truth, readings = run(make, quantity, 'offset', 0.125, 10)
    assert (readings[BEFORE:] - truth[BEFORE:] == 0.125).all()


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_noise_has_its_standard_deviation(make, quantity):
    truth, readings = run(make, quantity, 'noise', 0.25)
    noise = (readings - truth)[BEFORE:]
    # Fixed seed, fixed numbers; four standard errors.
    assert noise.std() == pytest.approx(0.25, rel=4.0 / math.sqrt(2.0 * TICKS))
    assert abs(noise.mean()) < 4.0 * 0.25 / math.sqrt(TICKS)


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_delay_reads_the_truth_of_so_many_ticks_before(make, quantity):
    truth, readings = run(make, quantity, 'delay', 3.0 * PERIOD, 10)
    assert readings[BEFORE:].tolist() == truth[BEFORE - 3:-3].tolist()


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_time_constant_lags_a_ramp_by_itself(make, quantity):
    # The rows are ramps of 10 a tick: y' = (x - y)/T has the exact solution below.
    lag = 4.0 * PERIOD
    truth, readings = run(make, quantity, 'time_constant', lag, 60)
    time = PERIOD * np.arange(1, 61)[:, None]
    behind = 10.0 / PERIOD * lag * (1.0 - np.exp(-time / lag))
    assert readings[BEFORE:] == pytest.approx(truth[BEFORE:] - behind, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize('quantity', QUANTITIES)
def test_dropout_misses_readings_with_its_probability_and_leaves_the_others(make, quantity):
    truth, readings = run(make, quantity, 'dropout', 0.3)
    missing = np.isnan(readings[BEFORE:])
    assert missing.mean() == pytest.approx(0.3, abs=4.0 * math.sqrt(0.21 / TICKS))
    assert (readings[BEFORE:][~missing] == truth[BEFORE:][~missing]).all()


def test_both_spools_have_the_fault_of_the_spool(make):
    truth, readings = run(make, 'spool', 'offset', 0.5, 10, spools=2)
    assert truth.shape[1] == 2
    assert (readings[BEFORE:] - truth[BEFORE:] == 0.5).all()


def test_a_fault_that_ends_leaves_the_truth(make):
    bench = make({'fault.position.stuck': True, 'fault.effort.delay': 0.01}, remember=True)
    bench.rows(20)
    bench.set(remember=True)
    truth, readings = bench.rows(5, first=20)
    assert readings.tolist() == truth.tolist()


def test_faults_come_on_top_of_the_sensor(make):
    bench = make({'fault.position.delay': 2e-3, 'fault.position.offset': 7.3}, delay=3e-3,
                 position_resolution=0.5)
    truth, readings = bench.rows(20)
    expected = truth[:-5, 1] + 7.5
    assert readings[5:, 1].tolist() == expected.tolist()


def test_the_same_row_shown_again_reads_as_before(make):
    bench = make({'fault.position.noise': 1.0, 'fault.velocity.time_constant': 0.01})
    bench.rows(5)
    first = bench.read(50)
    assert bench.read(50) == first
    truth, other = bench.rows(5, first=6)
    again = make({'fault.position.noise': 1.0, 'fault.velocity.time_constant': 0.01})
    assert again.rows(11)[1][6:].tolist() == other.tolist()


def test_a_dropout_does_not_spoil_what_a_stuck_instrument_keeps(make):
    bench = make({'fault.position.off': True}, remember=True)
    bench.rows(3)
    bench.set({'fault.position.stuck': True}, remember=True)
    assert bench.read(30)[1] == bench.row(20)[1]
