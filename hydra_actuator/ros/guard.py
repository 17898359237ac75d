# SPDX-License-Identifier: Apache-2.0
"""
Callbacks that survive their own exceptions.

rclpy ends spin on an exception in a service callback, answers nobody, and loses the traceback of
one in a lifecycle callback. Here it is logged whole, and answered.
"""

from collections.abc import Callable
import functools
import traceback

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
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
    """Return a service callback that answers an exception as a refusal with the reason."""
    def guarded(request, response):
        try:
            return callback(request, response)
        except Exception as error:
            log_traceback(node, name)
            _refuse(request, response, f'{error!r}')
            return response
    return guarded


def guard_services(node) -> None:
    """Have all services that the node has now answer exceptions, where rclpy 7 answers nobody."""
    for service in node.services:
        service.callback = answered(node, service.srv_name, service.callback)


def _refuse(request, response, reason: str) -> None:
    """Write a refusal into a response that can tell one; others stay as they are."""
    if hasattr(response, 'success'):
        response.success = False
        if hasattr(response, 'message'):
            response.message = reason
    refused = SetParametersResult(successful=False, reason=reason)
    if isinstance(response, SetParametersAtomically.Response):
        response.result = refused
    if isinstance(response, SetParameters.Response):
        # Those before the culprit are answered, and were perhaps set.
        rest = len(request.parameters) - len(response.results)
        response.results = [*response.results, *[refused] * rest]
