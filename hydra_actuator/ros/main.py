# SPDX-License-Identifier: Apache-2.0
"""
The node's process: signals in the main thread, everything else in another.

A signal in any phase, imports and compilation included, ends in exit code 0 within two seconds:
the serving thread is asked to stop, and left behind where it is if it cannot answer in time. The
process then leaves at once: taking the interpreter apart takes longer than all the rest.
"""

import gc
import os
import sys
import threading
import traceback
from typing import NoReturn

from hydra_actuator.errors import InputError
from hydra_actuator.ros.stopping import end_waiting, take_signals, wait_for_signal

# Time [s] that the serving thread has to end after a signal.
PATIENCE = 1.2


class Service:
    """The node from `rclpy.init` to `try_shutdown`, run by one thread."""

    def __init__(self, arguments: list[str]):
        """Take the arguments from `--ros-args` on."""
        self.refusal = ''
        self.crashed = False
        self._arguments = arguments
        self._stopping = threading.Event()
        self._executor = None
        self.thread = threading.Thread(target=self._run, name='node', daemon=True)

    def stop(self) -> None:
        """Ask for the end, from another thread."""
        self._stopping.set()
        executor = self._executor
        if executor is not None:
            executor.wake()

    def _run(self) -> None:
        try:
            self._serve()
        except InputError as refusal:
            self.refusal = str(refusal)
        except Exception:
            self.crashed = True
            traceback.print_exc()
        finally:
            end_waiting()

    def _serve(self) -> None:
        from hydra_actuator.ros.node import ActuatorNode
        import rclpy

        if self._stopping.is_set():
            return
        _initialise(self._arguments)
        try:
            node = _made(ActuatorNode)
            try:
                self._spin(node)
            finally:
                node.close()
                del node
        finally:
            rclpy.try_shutdown()
            # With its last reference goes the participant: others hear that it has left, and
            # its shared memory is freed.
            gc.collect()

    def _spin(self, node) -> None:
        from hydra_actuator.ros.guard import log_traceback
        from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

        executor = SingleThreadedExecutor()
        executor.add_node(node)
        self._executor = executor
        if not self._stopping.is_set():
            node.autostart(self._stopping.is_set)
        while not self._stopping.is_set():
            try:
                executor.spin_once(timeout_sec=0.5)
            except ExternalShutdownException:
                break
            except Exception:
                log_traceback(node, 'callback')
        self._executor = None
        executor.shutdown(timeout_sec=0.0)


def main(arguments: list[str]) -> NoReturn:
    """Run the node until a signal, then end the process; raises InputError."""
    take_signals()
    # A short switch interval keeps the solver's thread from waiting for its turn.
    sys.setswitchinterval(1e-4)
    service = Service(arguments)
    service.thread.start()
    wait_for_signal()
    service.stop()
    service.thread.join(PATIENCE)
    # If it is alive still, it compiles or imports and cannot be interrupted; nothing is open yet.
    if service.refusal:
        raise InputError(service.refusal)
    _leave(1 if service.crashed else 0)


def _initialise(arguments: list[str]) -> None:
    """Initialise rclpy without its signal handlers; InputError for what ROS cannot parse."""
    from hydra_actuator.ros.security import security_missing, security_wanted
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    try:
        rclpy.init(
            args=['hydra_actuator', *arguments],
            signal_handler_options=SignalHandlerOptions.NO)
    except Exception as error:
        raise InputError(_first_sentence(error)) from None
    if security_wanted():
        rclpy.get_rmw_implementation_identifier()
        missing = security_missing()
        if missing:
            rclpy.try_shutdown()
            raise InputError(f'ROS_SECURITY_ENABLE is set, but {missing}')


def _made(node_class):
    """Return the node; InputError with one line where the middleware refuses it."""
    try:
        return node_class()
    except Exception as error:
        if type(error).__name__ == 'RCLError':
            raise InputError(_first_sentence(error)) from None
        raise


def _first_sentence(error: BaseException) -> str:
    """Return what rcl says without the places in its own source."""
    text = ' '.join(str(error).split())
    return text.split(', at /', 1)[0]


def _leave(code: int) -> NoReturn:
    """End the process at once, with what is printed so far."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
