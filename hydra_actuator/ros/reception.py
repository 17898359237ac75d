# SPDX-License-Identifier: Apache-2.0
"""
Receive messages of a few subscriptions in a thread of its own, as bytes.

An rclpy executor rebuilds its whole wait set around every message: half a millisecond of
interpreter time for one at 1 kHz, in a process that needs the interpreter for other things. A
wait set of these subscriptions alone costs a tenth of that. The executor does not see them:
their callback group never lets it.
"""

from collections.abc import Callable, Iterable
from operator import itemgetter
import time

from hydra_actuator.ros.worker import Worker
from rclpy.callback_groups import CallbackGroup
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.subscription import Subscription

# How long the thread may stay in one wait [ns]: the delay with which it notices its end.
_WAIT = 50_000_000

# Called with (message bytes, receive time [ns], send time [ns]).
Receiver = Callable[[bytes, int, int], None]


class HiddenGroup(CallbackGroup):
    """A callback group whose members no executor ever runs."""

    def can_execute(self, entity) -> bool:
        """Refuse."""
        return False

    def beginning_execution(self, entity) -> bool:
        """Refuse."""
        return False

    def ending_execution(self, entity) -> None:
        """Have nothing to end."""


class Reception:
    """Hands the messages of subscriptions to their receivers, one after the other."""

    def __init__(self, node: Node, on_error: Callable[[BaseException], None]):
        self._node = node
        self._on_error = on_error
        self._group = HiddenGroup()
        self._receivers: list[tuple[Subscription, Receiver]] = []
        self._worker = Worker('reception', self._run)

    def subscribe(self, message_type, topic: str, receiver: Receiver, **settings) -> str:
        """Add a subscription, before `start`; return the full name of its topic."""
        subscription = self._node.create_subscription(
            message_type, topic, lambda message: None, raw=True, callback_group=self._group,
            **settings)
        self._receivers.append((subscription, receiver))
        return subscription.topic_name

    def start(self) -> None:
        """Drop what came before now, then receive."""
        subscriptions = [subscription for subscription, _ in self._receivers]
        for subscription in subscriptions:
            while _take(subscription) is not None:
                pass
        self._worker.start(subscriptions)

    def stop(self) -> None:
        """End the thread; what comes from now on is not received."""
        self._worker.stop()

    def destroy(self) -> None:
        """Stop, and give the subscriptions up."""
        self.stop()
        for subscription, _ in self._receivers:
            self._node.destroy_subscription(subscription)
        self._receivers.clear()

    def _run(self, subscriptions: Iterable[Subscription]) -> None:
        wait_set = rclpy_implementation.WaitSet(
            len(self._receivers), 0, 0, 0, 0, 0, self._node.context.handle)
        with wait_set:
            while not self._worker.stopping:
                wait_set.clear_entities()
                for subscription in subscriptions:
                    wait_set.add_subscription(subscription.handle)
                try:
                    wait_set.wait(_WAIT)
                    ready = wait_set.get_ready_entities('subscription')
                    self._receive(ready)
                except Exception as error:
                    self._on_error(error)

    def _receive(self, ready: list[int]) -> None:
        """Hand over all that has come, in the order in which it was sent."""
        waiting = [
            (subscription, receiver) for subscription, receiver in self._receivers
            if subscription.handle.pointer in ready]
        heads: list[tuple[int, int, bytes, tuple[Subscription, Receiver]]] = []
        while not self._worker.stopping:
            for pair in waiting:
                taken = _take(pair[0])
                if taken is not None:
                    data, times = taken
                    received = times['received_timestamp'] or time.time_ns()
                    heads.append((times['source_timestamp'] or received, received, data, pair))
            if not heads:
                return
            first = min(heads, key=itemgetter(0))
            heads.remove(first)
            sent, received, data, pair = first
            waiting = [pair]
            pair[1](data, received, sent)


def _take(subscription: Subscription) -> tuple[bytes, dict] | None:
    """Take a message as bytes with its times, None if there is none."""
    with subscription.handle:
        return subscription.handle.take_message(subscription.msg_type, True)
