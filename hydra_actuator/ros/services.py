# SPDX-License-Identifier: Apache-2.0
"""
The services of a node: reset, step, pause, record, snapshot, clear_faults, enable.

What a service cannot do now it refuses with the reason; it never changes the lifecycle state.
"""

from collections.abc import Callable

from hydra_actuator.errors import InputError
from hydra_actuator.ros.diagnostics import Reports
from hydra_actuator.ros.guard import answered
from hydra_actuator.ros.rig import Rig
from hydra_actuator.ros.statuses import OK, WARN
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger


class Services:
    """
    Offers the services, and does on the rig what they ask.

    `rig` gives what the node has now: None while it is not configured; `forget_faults` sets the
    parameters of faults to none.
    """

    def __init__(self, node: Node, rig: Callable[[], Rig | None], reports: Reports):
        self.is_active: Callable[[], bool] = lambda: False
        self.forget_faults: Callable[[], None] = lambda: None
        self._rig = rig
        self._reports = reports
        for name, action in (
            ('reset', self.reset), ('step', self.step), ('clear_faults', self._clear_faults),
            ('snapshot', self._snapshot),
        ):
            self._offer(node, Trigger, name, lambda request, action=action: action())
        for name, switch in (
            ('pause', self.pause), ('record', self._record), ('enable', self._enable)
        ):
            self._offer(node, SetBool, name, lambda request, switch=switch: switch(request.data))

    def _offer(self, node: Node, service_type, name: str, action: Callable) -> None:
        """Create a service whose action returns (success, message)."""
        def call(request, response):
            response.success, response.message = action(request)
            return response
        node.create_service(service_type, f'~/{name}', answered(node, name, call))

    @property
    def paused(self) -> bool:
        """Tell whether the node is paused."""
        rig = self._rig()
        return rig is not None and rig.paused

    def reset(self) -> tuple[bool, str]:
        """Return to the initial state; tell whether it was done, and what or why not."""
        if not self.is_active():
            return False, 'not active'
        if not self._rig().reset():
            return False, 'the solver did not get round to it'
        self._reports.event(OK, 'Solver', 'reset to the initial state')
        return True, 'initial state, command 0'

    def step(self) -> tuple[bool, str]:
        """Run one tick, paused only."""
        rig = self._rig()
        if not self.is_active() or not rig.paused:
            return False, 'not paused'
        if not rig.step():
            return False, rig.failure
        return True, f'simulated time {rig.actuator.time:.9g} s'

    def pause(self, paused: bool) -> tuple[bool, str]:
        """Stop ticking, or go on."""
        rig = self._rig()
        if not self.is_active():
            return False, 'not active'
        if paused == rig.paused:
            return True, 'paused already' if paused else 'running already'
        if paused:
            rig.pause()
        else:
            rig.resume()
        self._reports.event(OK, 'Solver', 'paused' if paused else 'resumed')
        return True, f'simulated time {rig.actuator.time:.9g} s'

    def _record(self, wanted: bool) -> tuple[bool, str]:
        rig = self._rig()
        if rig is None:
            return False, 'not configured'
        recorder = rig.recorder
        if wanted and recorder.recording:
            return True, f'{recorder.doing} already'
        if wanted:
            try:
                rig.record()
            except (InputError, OSError) as error:
                return False, str(error)
            return True, recorder.doing
        if not recorder.recording:
            return True, 'not recording'
        kept = recorder.snapshots is not None
        complete = recorder.close()
        if kept and complete:
            return True, 'nothing is kept any more'
        return complete, f'{recorder.path} is {"complete" if complete else "not complete"}'

    def _snapshot(self) -> tuple[bool, str]:
        rig = self._rig()
        return (False, 'not configured') if rig is None else rig.recorder.snapshot()

    def _clear_faults(self) -> tuple[bool, str]:
        rig = self._rig()
        if rig is not None and not rig.faults.clear():
            return False, 'the solver did not get round to it'
        self.forget_faults()
        return True, 'no faults, no script'

    def _enable(self, enabled: bool) -> tuple[bool, str]:
        rig = self._rig()
        if rig is None:
            return False, 'not configured'
        if not rig.plant.set_enabled(enabled):
            return False, 'the solver did not get round to it'
        state = 'enabled' if enabled else 'emergency stop: valve centred, supply off'
        self._reports.event(OK if enabled else WARN, 'Solver', state)
        return True, state
