# SPDX-License-Identifier: Apache-2.0
"""
The services of simulation_interfaces, where that package (1.x) can be imported.

    get_simulation_state, set_simulation_state, step_simulation, reset_simulation,
    get_simulator_features

They stand in the node's namespace like its own services, and do what those do: playing is ticking,
paused is paused, stopped is paused in the initial state. A node that is not active is stopped.
Neglected: spawning, entities, worlds; quitting the process.
"""

from collections.abc import Callable
import importlib

from hydra_actuator.ros.guard import log_traceback
from hydra_actuator.ros.services import Services
from rclpy.node import Node

# What of SimulatorFeatures is offered; a name that a package lacks is left out.
FEATURES = (
    'SIMULATION_RESET', 'SIMULATION_RESET_TIME', 'SIMULATION_RESET_STATE',
    'SIMULATION_STATE_GETTING', 'SIMULATION_STATE_SETTING', 'SIMULATION_STATE_PAUSE',
    'STEP_SIMULATION_SINGLE', 'STEP_SIMULATION_MULTIPLE')


class SimulationServices:
    """Offers the services of simulation_interfaces by those of the node itself."""

    def __init__(self, node: Node, services: Services):
        """Offer nothing where the package is not installed."""
        try:
            self._msg = importlib.import_module('simulation_interfaces.msg')
            srv = importlib.import_module('simulation_interfaces.srv')
        except ImportError:
            return
        self._node = node
        self._services = services
        for type_name, name, answer in (
            ('GetSimulationState', 'get_simulation_state', self._get_state),
            ('SetSimulationState', 'set_simulation_state', self._set_state),
            ('StepSimulation', 'step_simulation', self._step),
            ('ResetSimulation', 'reset_simulation', self._reset),
            ('GetSimulatorFeatures', 'get_simulator_features', self._features),
        ):
            node.create_service(
                getattr(srv, type_name), f'~/{name}', self._answered(name, answer))

    def _answered(self, name: str, answer: Callable) -> Callable:
        """Return a callback that survives whatever happens, and says so."""
        def call(request, response):
            try:
                answer(request, response)
            except Exception as error:
                log_traceback(self._node, name)
                if hasattr(response, 'result'):
                    self._say(response, 'OPERATION_FAILED', repr(error))
            return response
        return call

    def _say(self, response, result: str, message: str = '') -> None:
        response.result.result = getattr(self._msg.Result, f'RESULT_{result}')
        response.result.error_message = message

    def _tell(self, response, done: tuple[bool, str]) -> None:
        """Answer with what a service of the node itself answered."""
        self._say(response, 'OK' if done[0] else 'OPERATION_FAILED', '' if done[0] else done[1])

    @property
    def _state(self) -> int:
        states = self._msg.SimulationState
        if not self._services.is_active():
            return states.STATE_STOPPED
        return states.STATE_PAUSED if self._services.paused else states.STATE_PLAYING

    def _get_state(self, request, response) -> None:
        response.state.state = self._state
        self._say(response, 'OK')

    def _set_state(self, request, response) -> None:
        """Play, pause or stop; stopping is pausing and a reset."""
        states, wanted = self._msg.SimulationState, request.state.state
        if wanted == self._state:
            response.result.result = type(response).ALREADY_IN_TARGET_STATE
        elif wanted == states.STATE_STOPPED:
            done = self._services.pause(True)
            self._tell(response, self._services.reset() if done[0] else done)
        elif wanted in (states.STATE_PLAYING, states.STATE_PAUSED):
            self._tell(response, self._services.pause(wanted == states.STATE_PAUSED))
        else:
            self._say(response, 'FEATURE_UNSUPPORTED', 'a signal ends the process')

    def _step(self, request, response) -> None:
        for _ in range(request.steps):
            done = self._services.step()
            if not done[0]:
                self._say(response, 'INCORRECT_STATE', done[1])
                return
        self._say(response, 'OK')

    def _reset(self, request, response) -> None:
        """Reset state and time together, as there is no other way."""
        if request.scope and not request.scope & type(request).SCOPE_STATE:
            self._say(response, 'FEATURE_UNSUPPORTED', 'state and time are reset together')
            return
        self._tell(response, self._services.reset())

    def _features(self, request, response) -> None:
        features = self._msg.SimulatorFeatures
        response.features.features = [
            getattr(features, name) for name in FEATURES if hasattr(features, name)]
