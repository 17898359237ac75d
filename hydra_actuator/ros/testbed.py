# SPDX-License-Identifier: Apache-2.0
"""
Real nodes for a test: on a ROS domain that nobody else has, on this machine's loopback only.

    with Testbed(folder) as bed:
        client = bed.lockstep({'solver.cells': 100})
        state = client.connect()
        state = client.step(0.1)

While it is open, this process's environment is that of the domain: contexts that are initialised
meanwhile find the nodes.
"""

from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

from hydra_actuator.errors import Failure, InputError
from hydra_actuator.parameters import load_parameters
from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.client import LockstepClient
from hydra_actuator.ros.domain import alone
import rclpy
from rclpy.context import Context

# The first start on a machine compiles the solver; a node that is active answers soon.
START_PATIENCE = 600.0
ANSWER_PATIENCE = 60.0


class Testbed:
    """A domain, the nodes on it and this side's clients; all of them end with its context."""

    # Not a test, whatever its name looks like.
    __test__ = False

    def __init__(self, folder: Path):
        """Keep parameter files and recordings in `folder`."""
        self._folder = folder
        self._stack = ExitStack()
        self._children: list[ChildNode] = []
        self._context: Context | None = None

    def __enter__(self) -> 'Testbed':
        self.domain = self._stack.enter_context(alone())
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def close(self) -> None:
        """Stop everything; raises Failure if a node has ended by itself before."""
        died = [child.last_line for child in self._children if child.died]
        self._stack.close()
        if died:
            raise Failure(f'a node ended during the test; {died[0]}')

    def start(
        self, overrides: Mapping[str, object], *, files: tuple[str | Path, ...] = (),
        namespace: str = '',
    ) -> ChildNode:
        """
        Start a node and return it once it is active.

        It has the parameters of the files, then of `overrides`; only these can have it record,
        into the folder of the testbed unless they say where. Raises InputError for what cannot
        be, Failure with the node's last words if it does not come up.
        """
        parameters = load_parameters(*files, overrides={
            'recording.enabled': False, 'recording.directory': str(self._folder / 'recordings'),
            **overrides})
        if not parameters['autostart']:
            raise InputError('autostart is false: a node of a testbed has to become active')
        path = self._folder / f'node_{len(self._children)}.yaml'
        path.write_text(parameters.as_yaml())
        remapping = ['-r', f'__ns:={namespace}'] if namespace else []
        child = ChildNode(['--params-file', str(path), *remapping])
        self._stack.enter_context(child)
        child.wait_until_active(START_PATIENCE)
        self._children.append(child)
        return child

    def lockstep(
        self, overrides: Mapping[str, object], *, files: tuple[str | Path, ...] = (),
        namespace: str = '',
    ) -> LockstepClient:
        """Start a node in lockstep, as `start` does; return its client, not yet connected."""
        mode = overrides.get('timing.mode', 'lockstep')
        if mode != 'lockstep':
            raise InputError(f'timing.mode is {mode}: a client steps a node in lockstep only')
        self.start({**overrides, 'timing.mode': 'lockstep'}, files=files, namespace=namespace)
        if self._context is None:
            self._context = Context()
            rclpy.init(context=self._context, args=[])
            self._stack.callback(rclpy.try_shutdown, context=self._context)
        node = rclpy.create_node(
            f'lockstep_client_{len(self._children)}', context=self._context,
            start_parameter_services=False)
        self._stack.callback(node.destroy_node)
        return self._stack.enter_context(
            LockstepClient(node, f'{namespace}/actuator', ANSWER_PATIENCE))
