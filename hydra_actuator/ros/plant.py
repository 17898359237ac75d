# SPDX-License-Identifier: Apache-2.0
"""
The actuator in a thread of its own, ticking as a clock source says.

A tick: wait for the grant, note the command that holds now, solve the period that ends now with
the command of the grant, or else the one noted a tick before (causal: what is known at an instant
acts from it on), put the row into the ring. In real time a compiled loop ticks in its place while
nothing else is due. The thread never publishes, logs or writes. Whatever else happens to the plant
(a parameter, the supply) is an order, carried out between two ticks.
"""

from collections import deque
from collections.abc import Callable
import threading
import traceback

from hydra_actuator.actuator import Actuator
from hydra_actuator.realtime.memory import frame_is_due
from hydra_actuator.ros.clocks.source import Act, ClockSource, Grant, Inputs
from hydra_actuator.ros.commands import CENTRED
from hydra_actuator.ros.grid_loop import GridLoop, Standing
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.ros.worker import Worker

# Longest wait [s] for an order, beside a period.
_PATIENCE = 1.0
# How long [s] a full ring keeps the thread from looking at its orders.
_LOOK = 0.05


class Plant:
    """
    Runs an actuator: `start`, `stop`, one `step` while stopped, orders at any time.

    `failure` is '' or why it will not go on; `on_failure` is called in the plant's thread then,
    `on_faults` with the number of the first row of which other faults are true.
    """

    def __init__(
        self, actuator: Actuator, clock: ClockSource, setpoint: Setpoint, ring: Ring,
        field_rate: float = 0.0,
    ):
        """Take a clock whose period is one of the actuator's, or several."""
        self.failure = ''
        self.on_failure: Callable[[], None] = lambda: None
        self.on_faults: Callable[[int], None] = lambda number: None
        self.prepare_thread: Callable[[], None] = lambda: None
        self.loop: GridLoop | None = None
        self.resets = 0
        self.enabled = True
        self._actuator = actuator
        self._clock = clock
        self._setpoint = setpoint
        self._ring = ring
        self._periods = round(clock.period / actuator.period)
        self.frames_per_tick = min(1.0, field_rate * clock.period)
        self._orders: deque[Callable[[], None]] = deque()
        self._was_reset = threading.Event()
        self._worker = Worker('solver', self._run)
        self._acts = {Act.SOLVE: self._solve, Act.RESET: self._reset, Act.REPEAT: self._repeat}
        self._stamp = 0
        self._rows = 0
        self._edition = -1
        self._held = (*CENTRED, 0.0)

    @property
    def rows(self) -> int:
        """How many rows the ring was given: the number of the next one."""
        return self._rows

    @property
    def running(self) -> bool:
        """Tell whether ticks are under way."""
        return self._worker.running

    def start(self) -> None:
        """Begin ticking; the first start puts the initial state into the ring."""
        self.failure = ''
        self._held = self._inputs()
        self._worker.start()

    def stop(self) -> None:
        """Stop after the tick under way; the state stays."""
        self._worker.stop(self._clock.wake)
        self._follow_orders()

    def step(self) -> bool:
        """Run one tick out of turn while stopped; False if it fails."""
        return self._perform(self._clock.out_of_turn(self._stamp))

    def order(self, action: Callable[[], None]) -> bool:
        """Have something done between two ticks and wait for it; False if it was not done."""
        if not self.running:
            action()
            return True
        done = threading.Event()

        def obey() -> None:
            action()
            done.set()
        self._orders.append(obey)
        self._clock.wake()
        return done.wait(_PATIENCE + self._clock.period)

    def reset(self) -> bool:
        """
        Return to the initial state with command 0; the load holds. False if it was not done.

        In real time it takes one tick of the grid, so that stamps go on by one period; simulated
        time begins anew.
        """
        self._was_reset.clear()
        self._clock.restart()
        if not self.running:
            return self.step()
        return self._was_reset.wait(_PATIENCE + self._clock.period)

    def set_enabled(self, enabled: bool) -> bool:
        """Switch valve command and supply on, or centre the valve and turn the supply off."""
        def switch() -> None:
            self.enabled = self._actuator.supply.on = enabled
            self._setpoint.centre()
            self._held = self._inputs()
        return self.order(switch)

    def _run(self) -> None:
        """Tick until stopped or failed; the thread's whole life."""
        try:
            self.prepare_thread()
            stamp = self._clock.start(self._stamp)
            if stamp is not None and not self._rows:
                self._push(stamp)
            self._tick_until_stopped()
        except Exception:
            self.failure = 'solver thread: ' + traceback.format_exc()
        finally:
            self._clock.stop()
        if self.failure:
            self.on_failure()

    def _tick_until_stopped(self) -> None:
        while not self._is_over():
            self._follow_orders()
            if self.loop is not None and self._has_ticked(self.loop):
                continue
            if self._clock.simulated and not self._ring.has_room(_LOOK):
                continue
            grant = self._clock.wait()
            if grant is not None:
                self._perform(grant)
            self.failure = self.failure or self._clock.failure

    def _is_over(self) -> bool:
        if self.loop is not None:
            # Before what it stands for is looked at: what comes later stays to be seen.
            self.loop.attend()
        return self._worker.stopping or bool(self.failure)

    def _has_ticked(self, loop: GridLoop) -> bool:
        """Leave the ticks to a compiled loop; False if the next one cannot be left to it."""
        self._tell_faults()
        before = self._rows
        standing, code = loop.run(Standing(self._rows, self._stamp, self._held), self.enabled)
        self._rows, self._stamp, self._held = standing
        self.failure = self._actuator.status_message(code) if code else self._clock.failure
        return self._rows > before or bool(self.failure)

    def _perform(self, grant: Grant) -> bool:
        """Do what a grant says; False if it failed."""
        return self._acts[grant.act](grant)

    def _solve(self, grant: Grant) -> bool:
        """Solve one tick with its inputs or those held, note those of now."""
        actuator, noted = self._actuator, self._inputs()
        held = self._held if grant.inputs is None else self._allowed(grant.inputs)
        tick = actuator.tick
        for _ in range(self._periods):
            code = actuator.tick_once(*held)
            if code:
                self.failure = actuator.status_message(code)
                return False
        self._held = noted
        self._push(grant.stamp, tick, held)
        return True

    def _reset(self, grant: Grant) -> bool:
        """Return to the initial state, and show it; simulated time counts from there."""
        supply = self._actuator.supply
        pressure = supply.pressure
        self._actuator.reset()
        self._actuator.advance(0.0)
        supply.pressure = pressure
        self._setpoint.centre()
        self._held = self._inputs()
        self.resets += 1
        if self._clock.simulated:
            self._ring.is_read(_PATIENCE)
            self._rows = 0
            self._edition = -1
        self._push(grant.stamp)
        self._was_reset.set()
        return True

    def _repeat(self, grant: Grant) -> bool:
        """Show the state once more, as the same row."""
        self._ring.push(
            self._rows - 1, grant.stamp, 0, self._held, self._actuator.row)
        self._ring.signal()
        return True

    def _push(self, stamp: int, tick: int = 0, held: tuple[float, ...] | None = None) -> None:
        """Put the state as it is into the ring, and the field if it is due."""
        actuator, ring, count = self._actuator, self._ring, self._rows
        self._tell_faults()
        ring.push(count, stamp, tick, self._held if held is None else held, actuator.row)
        share = self.frames_per_tick
        if frame_is_due(share, count):
            actuator.read_field(ring.frame())
            ring.push_frame(stamp, actuator.time)
        self._rows = count + 1
        self._stamp = stamp
        ring.signal()

    def _tell_faults(self) -> None:
        """Say so if other faults are true from the next row on."""
        edition = self._actuator.faults.edition
        if edition != self._edition:
            self._edition = edition
            self.on_faults(self._rows)

    def _inputs(self) -> Inputs:
        """Return the inputs that hold from now on."""
        return self._allowed(self._setpoint.sample())

    def _allowed(self, inputs: Inputs) -> Inputs:
        """Return inputs as the emergency stop lets them through."""
        return inputs if self.enabled else (*CENTRED, inputs[2])

    def _follow_orders(self) -> None:
        while self._orders:
            self._orders.popleft()()
