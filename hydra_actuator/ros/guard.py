# SPDX-License-Identifier: Apache-2.0
"""
Callbacks that survive their own exceptions.

rclpy ends spin on an exception in a service callback, answers nobody, and loses the traceback of
one in a lifecycle callback. Here it is logged whole, and answered.
"""

from collections.abc import Callable
import functools
import traceback

from rclpy.lifecycle import TransitionCallbackReturn


def log_traceback(node, doing: str) -> None:
    """Log the exception that is being handled, with what was being done."""
    node.get_logger().error(f'{doing}: {traceback.format_exc()}')


def transition(on_exception: TransitionCallbackReturn) -> Callable:
    """Make a lifecycle callback log an exception, and answer with `on_exception`."""
    def decorate(callback: Callable) -> Callable:
        @functools.wraps(callback)
        def guarded(node, state) -> TransitionCallbackReturn:
            try:
                return callback(node, state)
            except Exception as error:
                log_traceback(node, callback.__name__)
                node.problem = f'{callback.__name__}: {error!r}'
                return on_exception
        return guarded
    return decorate


def answered(node, name: str, callback: Callable) -> Callable:
    """Return a service callback that answers an exception with `success` false."""
    def guarded(request, response):
        try:
            return callback(request, response)
        except Exception as error:
            log_traceback(node, name)
            response.success = False
            if hasattr(response, 'message'):
                response.message = f'{error!r}'
            return response
    return guarded
