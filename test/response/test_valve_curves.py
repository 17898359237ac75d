# SPDX-License-Identifier: Apache-2.0
"""The valve's curves about null, against the formulas of its orifices."""

import math

from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.response.valve_curves import Bench, null_figures, valve_curves
import numpy as np
import pytest

EDGES = ('pa', 'pb', 'at', 'bt')
SPAN = 18.5e6
GAIN = 0.62 * 0.03 * math.sqrt(2.0 / 860.0)


def bench(lap: float = 0.0, **changes) -> Bench:
    """Return a bench; lap [m], positive is overlap."""
    return Bench(Parameters().replace({
        **{f'valve.overlap_{edge}': lap for edge in EDGES},
        **{f'valve.{name}': value for name, value in changes.items()}}))


def test_underlap_doubles_the_flow_gain_and_gives_a_pressure_gain():
    null, lap = null_figures(bench(-2e-5)), 2e-5
    flow_gain = 2.0 * GAIN * math.sqrt(0.5 * SPAN)
    flow_pressure = 0.5 * GAIN * lap / math.sqrt(0.5 * SPAN)
    assert null.flow_gain == pytest.approx(flow_gain, rel=1e-6)
    assert null.flow_pressure == pytest.approx(flow_pressure, rel=1e-6)
    assert null.pressure_gain == pytest.approx(flow_gain / flow_pressure, rel=1e-6)
    assert null.leakage == pytest.approx(2.0 * GAIN * lap * math.sqrt(0.5 * SPAN), rel=1e-6)
    assert (null.region, null.low, null.high) == ('underlap', -0.04, 0.04)


def test_zero_lap_without_leakage_has_no_pressure_loss():
    null = null_figures(bench())
    assert null.flow_gain == pytest.approx(GAIN * math.sqrt(0.5 * SPAN), rel=1e-6)
    assert math.isinf(null.pressure_gain)
    assert (null.flow_pressure, null.leakage, null.region) == (0.0, 0.0, 'none')


def test_overlap_is_a_dead_region_whose_width_is_the_overlap():
    null, curves = null_figures(bench(1e-5)), valve_curves(bench(1e-5), 0.1, 101)
    assert (null.region, null.low, null.high) == ('overlap', -0.02, 0.02)
    inside = np.abs(curves.spool) < 0.0199
    assert not curves.flow[inside].any()
    assert np.isnan(curves.load_pressure[inside]).all()
    outside = curves.spool > 0.0201
    assert curves.flow[outside] == pytest.approx(
        GAIN * (curves.spool[outside] * 5e-4 - 1e-5) * math.sqrt(0.5 * SPAN), rel=1e-9)


def test_leakage_alone_sets_the_pressure_gain_of_zero_lap():
    leak = 2e-12
    null = null_figures(bench(leakage=leak))
    assert null.flow_pressure == pytest.approx(leak, rel=1e-6)
    assert null.leakage == pytest.approx(leak * SPAN, rel=1e-9)
    assert null.pressure_gain == pytest.approx(GAIN * math.sqrt(0.5 * SPAN) / leak, rel=1e-4)


def test_unequal_edges_shift_the_overlap_of_each_side():
    null = null_figures(bench(overlap_pa=1e-5, overlap_bt=2e-5, overlap_pb=0.0, overlap_at=3e-5))
    assert (null.region, null.low, null.high) == ('overlap', -0.06, 0.04)


def test_load_flow_falls_as_the_root_of_the_pressure_left():
    one = bench()
    load = np.array([-0.5, 0.0, 0.5, 1.0]) * SPAN
    assert one.load_flow(np.full(4, 0.1), load) == pytest.approx(
        GAIN * 5e-5 * np.sqrt(0.5 * (SPAN - load)), rel=1e-9, abs=1e-15)


def test_blocked_edge_of_one_side_halves_its_ports_gain():
    one = bench(gain_pb=0.0, gain_bt=0.0, spools=2)
    assert one.port_gain(1) == 0.0
    assert one.port_gain(0) == pytest.approx(GAIN * math.sqrt(0.5 * SPAN), rel=1e-6)


def test_a_bench_without_pressure_drop_is_refused():
    with pytest.raises(InputError, match='no null curves'):
        Bench(Parameters().replace({'supply.pressure': 2e6}))
