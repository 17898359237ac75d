# SPDX-License-Identifier: Apache-2.0
"""
The actuator on the pacer's grid, in a thread of its own.

A tick: wait for its instant, note the command that holds now, solve the period that ends now
with the command noted one tick before (causal: what is known at an instant acts from it on), put
the row into the ring. The thread never publishes, logs or writes. Whatever else happens to the
plant (reset, a parameter, the supply) is an order, carried out between two ticks.

The stamp of a row is base + (ticks + slipped) * period, with base the system time of the start:
simulated time plus slip, whatever the clocks do meanwhile.
"""

from collections import deque
from collections.abc import Callable
import threading
import time
import traceback

from hydra_actuator.actuator import Actuator
from hydra_actuator.pacer import Pacer
from hydra_actuator.ros.commands import CENTRED
from hydra_actuator.ros.ring import Ring
from hydra_actuator.ros.setpoint import Setpoint
from hydra_actuator.ros.supply import Supply
from hydra_actuator.ros.worker import Worker

_NS = 1_000_000_000
# Longest wait [s] for an order, beside a period.
_PATIENCE = 1.0


class Plant:
    """
    Runs an actuator: `start`, `stop`, one `step` while stopped, orders at any time.

    `failure` is '' or why it will not go on; `on_failure` is called in the plant's thread then.
    """

    def __init__(
        self, actuator: Actuator, pacer: Pacer, setpoint: Setpoint, ring: Ring,
        field_rate: float = 0.0,
    ):
        self.failure = ''
        self.on_failure: Callable[[], None] = lambda: None
        self.prepare_thread: Callable[[], None] = lambda: None
        self.resets = 0
        self.enabled = True
        parameters = actuator.parameters
        self.supply = Supply(
            parameters['supply.pressure'], parameters['tank.pressure'], actuator.period)
        self._actuator = actuator
        self._pacer = pacer
        self._setpoint = setpoint
        self._ring = ring
        self._period_ns = actuator.period * _NS
        self._frames_per_tick = min(1.0, field_rate * actuator.period)
        self._orders: deque[Callable[[], None]] = deque()
        self._worker = Worker('solver', self._run)
        self._base = self._stamp = 0
        self._rows = 0
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
        self._worker.stop()
        self._follow_orders()

    def step(self) -> bool:
        """Run one period while stopped, stamped one period after the last; False if it fails."""
        return self._solve(self._stamp + round(self._period_ns))

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
        return done.wait(_PATIENCE + self._actuator.period)

    def reset(self) -> bool:
        """
        Return to the initial state with command 0, as an order; the load holds.

        While ticking, it takes one tick of the grid, so that stamps go on by one period.
        """
        return self.order(self._reset)

    def set_enabled(self, enabled: bool) -> bool:
        """Switch valve command and supply on, or centre the valve and turn the supply off."""
        def switch() -> None:
            self.enabled = self.supply.on = enabled
            self._setpoint.centre()
            self._held = self._inputs()
        return self.order(switch)

    def _run(self) -> None:
        """Tick until stopped or failed; the thread's whole life."""
        try:
            self.prepare_thread()
            self._pacer.start()
            self._base = max(time.time_ns(), self._stamp)
            if not self._rows:
                self._push(self._base)
            self._tick_until_stopped()
        except Exception:
            self.failure = 'solver thread: ' + traceback.format_exc()
        finally:
            self._pacer.stop()
        if self.failure:
            self.on_failure()

    def _tick_until_stopped(self) -> None:
        while not self._worker.stopping:
            index = self._pacer.wait()
            if index is None:
                self.failure = 'a tick was missed, and timing.overrun_policy is halt'
                return
            stamp = self._base + round(index * self._period_ns)
            resets = self.resets
            self._follow_orders()
            if self.resets != resets:
                self._push(stamp)
            elif not self._solve(stamp):
                return

    def _solve(self, stamp: int) -> bool:
        """Solve one period with the inputs held, note those of now; False if it failed."""
        actuator = self._actuator
        noted = self._inputs()
        pressure = self.supply.tick()
        if pressure is not None:
            actuator.set_supply_pressure(pressure)
        tick, held = actuator.tick, self._held
        code = actuator.tick_once(*held)
        if code:
            self.failure = actuator.status_message(code)
            return False
        self._held = noted
        self._push(stamp, tick, held)
        return True

    def _push(self, stamp: int, tick: int = 0, held: tuple[float, ...] | None = None) -> None:
        """Put the state as it is into the ring, and the field if it is due."""
        actuator, ring, count = self._actuator, self._ring, self._rows
        ring.push(stamp, tick, self._held if held is None else held, actuator.row)
        share = self._frames_per_tick
        if share and (not count or int(count * share) != int((count - 1) * share)):
            actuator.read_field(ring.frame())
            ring.push_frame(stamp, actuator.time)
        self._rows = count + 1
        self._stamp = stamp
        ring.signal()

    def _inputs(self) -> tuple[float, float, float]:
        """Return the inputs that hold from now on."""
        inputs = self._setpoint.sample()
        return inputs if self.enabled else (*CENTRED, inputs[2])

    def _follow_orders(self) -> None:
        while self._orders:
            self._orders.popleft()()

    def _reset(self) -> None:
        self._actuator.reset()
        self._actuator.advance(0.0)
        self.supply.forget()
        self._setpoint.centre()
        self._held = self._inputs()
        self.resets += 1
        if not self.running:
            self._push(self._stamp + round(self._period_ns))
