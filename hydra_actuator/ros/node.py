# SPDX-License-Identifier: Apache-2.0
"""
ActuatorNode, a managed lifecycle node: wiring only.

    unconfigured --configure--> inactive --activate--> active      (by itself with `autostart`)
        Rig is made                  Rig.start             a failure of the solver: error state,
                                                           outputs stop, back to unconfigured
"""

from collections.abc import Callable

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.ros import statuses
from hydra_actuator.ros.declare import ParameterDoor
from hydra_actuator.ros.diagnostics import DiagnosticsThread, Reports
from hydra_actuator.ros.guard import guard_services, log_traceback, transition
from hydra_actuator.ros.rig import Rig
from hydra_actuator.ros.services import Services
from hydra_actuator.ros.simulation import SimulationServices
from hydra_actuator.ros.solver_status import solver
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE
ERROR = TransitionCallbackReturn.ERROR


class ActuatorNode(LifecycleNode):
    """
    The actuator as a node.

    `problem` is '' or why the last transition or the solver failed.
    """

    def __init__(self, **settings):
        """Declare the parameters and stand there unconfigured; see `autostart`."""
        super().__init__('actuator', **settings)
        self.problem = ''
        self.rig: Rig | None = None
        self._active = False
        self._state_name = 'unconfigured'
        # Lifecycle and parameters; invalid requests come from anyone.
        guard_services(self)
        self.door = ParameterDoor(self)
        self.door.is_active = lambda: self._active
        self.door.on_change = self._change
        self.door.further_check = lambda changes: self.rig and self.rig.faults.check(changes)
        self._reports = Reports(self)
        services = Services(self, lambda: self.rig, self._reports)
        services.is_active = lambda: self._active
        services.forget_faults = self.door.forget_faults
        SimulationServices(self, services)
        self._failed = self.create_guard_condition(self._stop_after_failure)
        self._diagnostics = DiagnosticsThread(
            self._reports, self._statuses,
            lambda error: self.get_logger().error(f'diagnostics: {error!r}'))
        self._diagnostics.start()
        for reason in self.door.refusals.values():
            self.get_logger().error(reason)

    def autostart(self, stopping: Callable[[], bool] = lambda: False) -> bool:
        """Configure and activate if the parameter says so; tell whether the node is active."""
        if not self.get_parameter('autostart').value or self.trigger_configure() != SUCCESS:
            return False
        return not stopping() and self.trigger_activate() == SUCCESS

    def close(self) -> None:
        """Stop the solver, close the recording, fall silent, give everything up."""
        self._diagnostics.stop()
        self._drop_rig()
        self.destroy_node()

    @transition(FAILURE)
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the rig; the reason of a failure is in log and diagnostics."""
        self.problem = ''
        self._enter('configuring')
        try:
            self.rig = Rig(self, self.door.parameters(), self._reports, self._failed.trigger)
        except (InputError, Failure) as error:
            self.problem = str(error)
            self.get_logger().error(f'cannot configure: {error}')
            return FAILURE
        finally:
            self._enter('unconfigured' if self.rig is None else 'inactive')
        return SUCCESS

    @transition(ERROR)
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to tick."""
        self.problem = ''
        self._active = True
        self.rig.start()
        self._enter('active')
        period = self.rig.clock.period
        self.get_logger().info(f'active: {1.0 / period:.6g} Hz, {self.rig.recorder.doing}')
        return SUCCESS

    @transition(ERROR)
    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop after the tick; after a failure of the solver this is the way to the error."""
        self._active = False
        self.rig.stop()
        if self.rig.failure and not self.rig.clock.failure:
            return ERROR
        self._enter('inactive')
        return SUCCESS

    @transition(ERROR)
    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the recording and forget the rig."""
        self._drop_rig()
        self._enter('unconfigured')
        return SUCCESS

    @transition(ERROR)
    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the recording for good."""
        self._drop_rig()
        self._enter('finalized')
        return SUCCESS

    @transition(FAILURE)
    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Give the rig up and go back to unconfigured."""
        self._drop_rig()
        self._enter('unconfigured')
        return SUCCESS

    def _enter(self, state: str) -> None:
        self._state_name = state
        self._diagnostics.send()

    def _drop_rig(self) -> None:
        self._active = False
        rig = self.rig
        if rig is None:
            return
        rig.stop()
        # The last word in the recording: the figures of the whole run.
        self._diagnostics.send()
        self.rig = None
        if not rig.close():
            self.get_logger().error(f'{rig.recorder.path} is not complete')

    def _change(self, changes: dict[str, object]) -> None:
        """Take accepted parameters while there is a rig; others wait for the next configure."""
        rig = self.rig
        if rig is None:
            return
        table = rig.parameters.table
        live = {name: value for name, value in changes.items() if table[name].live}
        if live:
            rig.change(live)
        if len(live) < len(changes):
            self.get_logger().warning(
                f'{", ".join(changes.keys() - live.keys())}: from the next configure on')

    def _stop_after_failure(self) -> None:
        """Leave the active state because the plant did, in the executor's thread."""
        if self.rig is None or not self._active or not self.rig.failure:
            return
        self.problem = self.rig.failure
        self.get_logger().error(f'stopped: {self.problem}')
        self._reports.event(statuses.ERROR, 'Solver', self.problem)
        try:
            self.trigger_deactivate()
        except Exception:
            log_traceback(self, 'deactivate after a failure')

    def _statuses(self) -> list[statuses.Status]:
        rig = self.rig
        parts = statuses.idle(self._state_name) if rig is None else rig.statuses()
        return [solver(self._state_name, self.problem, self._active, rig), *parts]
