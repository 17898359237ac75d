# SPDX-License-Identifier: Apache-2.0
"""
The pytest plugin: actuators for tests of controllers, without any middleware or over real DDS.

    actuator            an Actuator of default parameters
    make_actuator       a function that makes one: make_actuator({'cylinder.mass': 20.0})
    actuator_node       a LockstepClient, connected to a node of default parameters
    make_actuator_node  a function that starts one: make_actuator_node({'solver.cells': 100})
    start_actuator      a function that starts a node in any mode and returns its process
    actuator_testbed    the ROS domain of a test, on which its nodes run

Every pytest loads this file: what is heavy is imported by the fixture that needs it.
"""

from collections.abc import Callable, Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from hydra_actuator.actuator import Actuator

Files = tuple[str | Path, ...]


@pytest.fixture(scope='session')
def make_actuator() -> Callable[..., 'Actuator']:
    """
    Return a function that makes actuators; no ROS needed.

    make_actuator({'cylinder.mass': 20.0}, files=('my.yaml',)): the parameters are the defaults,
    then the files', then the given ones. Raises ParameterError.
    """
    from hydra_actuator.actuator import Actuator
    from hydra_actuator.parameters import load_parameters

    def make(overrides: Mapping[str, object] | None = None, *, files: Files = ()) -> 'Actuator':
        return Actuator(load_parameters(*files, overrides=overrides))
    return make


@pytest.fixture
def actuator(make_actuator) -> 'Actuator':
    """Return an actuator of default parameters in its initial state; no ROS needed."""
    return make_actuator()


@pytest.fixture
def actuator_testbed(tmp_path) -> Iterator:
    """
    Hold a ROS domain for this test, on the loopback only; nodes started on it end with the test.

    A node that has ended by itself fails the test. See hydra_actuator.ros.testbed.
    """
    if find_spec('rclpy') is None:
        pytest.fail('real nodes need ROS 2: source it, or pip install "hydra_actuator[ros]"',
                    pytrace=False)
    from hydra_actuator.ros.testbed import Testbed
    with Testbed(tmp_path) as testbed:
        yield testbed


@pytest.fixture
def start_actuator(actuator_testbed) -> Callable:
    """
    Return a function that starts a node and returns its process (ChildNode) once it is active.

    start_actuator({'timing.mode': 'realtime'}, files=('my.yaml',), namespace='/left'), all of it
    optional. Recording is off unless asked for.
    """
    def start(overrides: Mapping[str, object] | None = None, **options):
        return actuator_testbed.start(overrides or {}, **options)
    return start


@pytest.fixture
def make_actuator_node(actuator_testbed) -> Callable:
    """
    Return a function that starts a node in lockstep and returns its LockstepClient, connected.

    make_actuator_node({'solver.cells': 100}); its arguments are those of start_actuator. The
    client's `state` is the initial one.
    """
    def make(overrides: Mapping[str, object] | None = None, **options):
        client = actuator_testbed.lockstep(overrides or {}, **options)
        client.connect()
        return client
    return make


@pytest.fixture
def actuator_node(make_actuator_node):
    """Start a node of default parameters in lockstep; return its LockstepClient, connected."""
    return make_actuator_node()
