# SPDX-License-Identifier: Apache-2.0
"""The services of simulation_interfaces, against a node of its own; only where it is installed."""

import pytest
from std_srvs.srv import Trigger


def test_without_the_package_the_node_has_its_own_services_only(node_process, peer):
    try:
        import simulation_interfaces  # noqa: F401
    except ImportError:
        pass
    else:
        pytest.skip('simulation_interfaces is installed')
    node_process('-p', 'timing.mode:=free_run')
    assert not peer.call(Trigger, '/actuator/step').success
    names = dict(peer.node.get_service_names_and_types())
    assert '/actuator/reset' in names
    assert not any('simulation_interfaces' in kind for kinds in names.values() for kind in kinds)


def test_state_steps_reset_and_features(node_process, peer):
    msg = pytest.importorskip('simulation_interfaces.msg')
    srv = pytest.importorskip('simulation_interfaces.srv')
    state, result = msg.SimulationState, msg.Result

    def call(kind, name, **fields):
        return peer.call(getattr(srv, kind), f'/actuator/{name}', **fields)

    def go(wanted):
        return call('SetSimulationState', 'set_simulation_state', state=state(state=wanted)).result

    def now():
        return call('GetSimulationState', 'get_simulation_state').state.state

    node_process('-p', 'timing.mode:=free_run')
    assert now() == state.STATE_PLAYING
    refused = call('StepSimulation', 'step_simulation', steps=1).result
    assert refused.result == result.RESULT_INCORRECT_STATE
    assert go(state.STATE_PAUSED).result == result.RESULT_OK
    assert now() == state.STATE_PAUSED
    assert go(state.STATE_PAUSED).result == srv.SetSimulationState.Response.ALREADY_IN_TARGET_STATE
    assert call('StepSimulation', 'step_simulation', steps=5).result.result == result.RESULT_OK
    assert call('ResetSimulation', 'reset_simulation').result.result == result.RESULT_OK
    assert go(state.STATE_STOPPED).result == result.RESULT_OK
    assert go(state.STATE_QUITTING).result == result.RESULT_FEATURE_UNSUPPORTED
    assert go(state.STATE_PLAYING).result == result.RESULT_OK
    features = call('GetSimulatorFeatures', 'get_simulator_features').features.features
    assert msg.SimulatorFeatures.STEP_SIMULATION_SINGLE in features
