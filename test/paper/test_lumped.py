# SPDX-License-Identifier: Apache-2.0
"""The lumped model obeys what the books say of two volumes of oil and a valve."""

import math

from hydra_actuator.errors import InputError
from hydra_actuator.paper.drive import sine
from hydra_actuator.paper.lumped import LumpedActuator
from hydra_actuator.verification.spool_response import paper_parameters
import numpy as np
import pytest

LOSSLESS = {
    'supply_line.friction': 'none', 'line_1.friction': 'none', 'line_2.friction': 'none',
    'return_line.friction': 'none', 'cylinder.port_loss_1': 0.0, 'cylinder.port_loss_2': 0.0,
    'cylinder.viscous_friction': 0.0}


def constant(opening):
    return lambda times: opening + 0.0 * times


def lumped(changes):
    return LumpedActuator(paper_parameters().replace(changes))


def test_no_load_speed_is_the_valves_flow_at_half_the_supply_pressure():
    p = paper_parameters()
    times = np.linspace(0.0, 0.4, 400)
    found = lumped({**LOSSLESS, 'cylinder.stiffness': 0.0, 'initial.position': -0.09}).follow(
        constant(0.2), times)
    half = 0.5 * p['supply.pressure']
    flow = 0.62 * 0.03 * 0.2 * 5e-4 * math.sqrt(2.0 * half / 860.0)
    speed = flow / (p['cylinder.area_1'] * (1.0 + half / p['fluid.bulk_modulus']))
    # the start's swing has faded to a ten-thousandth by then
    assert found.velocity[-1] == pytest.approx(speed, rel=1e-3)
    assert found.inlet_drop[-1] == pytest.approx(half, rel=1e-3)
    assert found.outlet_drop[-1] == pytest.approx(half, rel=1e-3)


def test_trapped_oil_swings_the_piston_at_merritts_frequency():
    p = paper_parameters()
    times = np.arange(0.0, 0.1, 1e-5)
    found = lumped(LOSSLESS).follow(constant(0.0), times, start=(0.0, 1e-3))
    bore = 0.25 * math.pi * 0.016 ** 2
    volume = p['cylinder.area_1'] * 0.2 + bore * 0.2
    modulus = p['fluid.bulk_modulus'] + p['initial.pressure_1']
    omega = math.sqrt((2.0 * modulus * p['cylinder.area_1'] ** 2 / volume
                       + p['cylinder.stiffness']) / p['cylinder.mass'])
    signs = np.flatnonzero(np.diff(np.sign(found.position[1:]))) + 1
    share = found.position[signs] / (found.position[signs] - found.position[signs + 1])
    zeros = times[signs] + share * 1e-5
    period = 2.0 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
    # zeros between samples by straight lines; the amplitude is a millionth of the stroke
    assert 2.0 * math.pi / period == pytest.approx(omega, rel=1e-5)


def test_stiff_oil_gives_equal_drops_at_both_edges():
    times = np.linspace(0.0, 0.1, 2000)
    worst = []
    for modulus in (1.4534e9, 1.4534e11 / 4.0):
        found = lumped({'fluid.bulk_modulus': modulus}).follow(sine(16.25), times)
        # not while a valve that has just reversed lets the chambers change pressure
        judged = (np.abs(sine(16.25)(times)) > 0.3) & (times > 0.05)
        worst.append(np.abs(found.inlet_drop - found.outlet_drop)[judged].max())
    assert worst[0] > 50e3
    # compression makes the asymmetry, so it falls with the oil's modulus, 25 times higher here
    assert worst[1] < worst[0] / 8.0


def test_flow_through_a_path_loses_its_pressure_on_edge_wall_and_port():
    model = LumpedActuator(paper_parameters())
    flow, drop = model.path(1.0, 0, 5e6)
    velocity = flow / (0.25 * math.pi * 0.016 ** 2)
    walls = 0.5 * 860.0 * 1.9 * 0.8 * velocity ** 2
    port = 0.5 * 860.0 * 0.75 * (velocity ** 2 + (flow / 1e-3) ** 2)
    assert drop == pytest.approx(0.5 * 860.0 * (flow / (0.62 * 0.03 * 5e-4)) ** 2, rel=1e-12)
    assert drop + walls + port == pytest.approx(21e6 - 5e6, rel=1e-12)


def test_flow_changes_sides_with_the_valve_and_sign_with_the_pressure():
    model = LumpedActuator(paper_parameters())
    assert model.path(-0.5, 0, 5e6) == model.path(0.5, 0, 26e6)
    assert model.path(0.5, 0, 26e6) == pytest.approx(
        [-value for value in model.path(0.5, 0, 16e6)], rel=1e-12)
    assert model.path(0.5, 0, 5e6) == model.path(-0.5, 1, 5e6)
    assert model.path(0.0, 0, 5e6)[0] == model.path(0.0, 1, 5e6)[0] == 0.0


def test_the_pump_gives_no_more_than_its_flow():
    model = lumped({'supply.max_flow': 1e-4})
    flow, drop = model.path(1.0, 0, 5e6)
    assert flow == 1e-4
    assert drop == pytest.approx(0.5 * 860.0 * (1e-4 / (0.62 * 0.03 * 5e-4)) ** 2, rel=1e-12)
    assert model.path(-1.0, 0, 5e6)[0] < -1e-4


@pytest.mark.parametrize('name', ['valve.leakage', 'cylinder.leakage'])
def test_what_the_model_has_not_is_refused_by_name(name):
    with pytest.raises(InputError, match=name):
        lumped({name: 1e-13})


def test_friction_other_than_constant_is_refused_by_name():
    with pytest.raises(InputError, match=r'line_1\.friction'):
        lumped({'line_1.friction': 'steady'})
