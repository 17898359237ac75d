# SPDX-License-Identifier: Apache-2.0
"""
How late a node's ticks are, and how soon it answers: alone, flooded, beside a busy core.

Each case is a node of its own, active for some seconds, and beside it a bare sleeper on the same
deadlines: the machine's own lateness in the same seconds. A node's figures are those of its last
status `Real time`, counted by itself from its activation on.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass
from pathlib import Path
import time

from hydra_actuator.errors import Failure
from hydra_actuator.parameters import Parameters
from hydra_actuator.realtime.durations import DurationHistogram
from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.loads import busy_core, Flood, sleeper, Steps
from hydra_actuator.ros.measured import (
    change_all,
    ground,
    last_values,
    PATIENCE,
    Progress,
    recording_into,
)
from lifecycle_msgs.msg import Transition
import rclpy
from rclpy.node import Node

PERCENTILES = (50.0, 99.0, 99.9)
FLOODED, FLOODED_APART = 'node, 10 kHz of commands', 'the same, solver in a process'
STEPPED, STEPPED_APART = 'node, a command each 13.7 ms', 'the same, solver in a process'
NODE, APART = ('hydra_actuator', 'node'), ('hydra_actuator.ros.apart',)


@dataclass(frozen=True)
class Lateness:
    """Percentiles (PERCENTILES) and the largest [us], ticks and how many of them were missed."""

    percentiles: tuple[float, ...]
    largest: float
    ticks: int
    missed: int


@dataclass(frozen=True)
class Case:
    """
    One case, measured: lateness of the solver and of the sleeper beside it, and what came of it.

    node: None where there is the sleeper alone; execution: of the whole tick, as for lateness;
    latency: from a command to the first state that shows it; remark: what else was counted.
    """

    name: str
    beside: Lateness
    node: Lateness | None = None
    execution: tuple[float, ...] = ()
    latency: DurationHistogram | None = None
    remark: str = ''


def measure(
    duration: float, configs: list[str], parameters: Parameters, output: Path, progress: Progress
) -> Iterator[Case]:
    """
    Yield the cases, `duration` [s] each.

    configs: parameter files of the nodes, which give `parameters`; output: folder of their
    recordings. Meanwhile this process's ROS environment is theirs. Raises Failure if a node fails.
    """
    cases = (_alone, _idle, _flooded, _flooded_apart, _beside_a_busy_core,
             _stepped, _stepped_apart)
    with ground():
        bench = _Bench(duration, configs, parameters, output)
        for done, case in enumerate(cases):
            bench.progress = lambda share, done=done: progress((done + share) / len(cases))
            yield case(bench)


def lines(case: Case) -> list[str]:
    """Return what to print of a case."""
    told = [case.name + (f' ({case.remark})' if case.remark else '')]
    if case.node is not None:
        told += [_line('lateness of ticks', case.node), _line('of a sleeper beside', case.beside),
                 f'  {"execution of ticks":<22}' + _row(case.execution)]
    else:
        told += [_line('lateness', case.beside)]
    if case.latency is not None:
        told += [f'  {"command to state":<22}' + _row((
            *(case.latency.percentile(percent) / 1e3 for percent in PERCENTILES),
            case.latency.maximum / 1e3))]
    return told


def _line(name: str, lateness: Lateness) -> str:
    return (f'  {name:<22}{_row((*lateness.percentiles, lateness.largest))}'
            f'   {lateness.missed} of {lateness.ticks}')


def _row(times: Sequence[float]) -> str:
    return ''.join(f'{time:9.0f}' for time in times)


def _alone(bench: '_Bench') -> Case:
    with sleeper(bench.parameters) as queue:
        bench.wait()
    return Case('bare sleeper', _of_sleeper(queue))


def _idle(bench: '_Bench') -> Case:
    with bench.node() as run:
        bench.wait()
    return run.case('node, no commands')


def _flooded(bench: '_Bench', command: Sequence[str] = NODE, name: str = FLOODED) -> Case:
    with bench.node(command) as run, Flood(run.driver) as flood:
        bench.wait()
    figures = run.values('Command')
    return run.case(name, remark=f'{flood.sent / bench.duration:.0f} sent a second, '
                    f'{int(figures["received"]) / bench.duration:.0f} received')


def _flooded_apart(bench: '_Bench') -> Case:
    return _flooded(bench, APART, FLOODED_APART)


def _beside_a_busy_core(bench: '_Bench') -> Case:
    with bench.node() as run, busy_core():
        bench.wait()
    return run.case('node, a busy core beside')


def _stepped(bench: '_Bench', command: Sequence[str] = NODE, name: str = STEPPED) -> Case:
    with (bench.node(command) as run,
          Steps(run.driver, bench.parameters['valve.stroke']) as steps):
        bench.wait()
    return run.case(
        name, steps.latency, f'{steps.latency.count} answered, {steps.lost} not')


def _stepped_apart(bench: '_Bench') -> Case:
    return _stepped(bench, APART, STEPPED_APART)


class _Bench:
    """What all cases share."""

    def __init__(
        self, duration: float, configs: list[str], parameters: Parameters, output: Path
    ):
        self.duration = duration
        self.parameters = parameters
        self.progress: Progress = lambda share: None
        self._arguments = recording_into(output, configs)

    def wait(self) -> None:
        """Let the case go on for its time."""
        begin = time.monotonic()
        while (elapsed := time.monotonic() - begin) < self.duration:
            self.progress(elapsed / self.duration)
            time.sleep(0.1)

    @contextmanager
    def node(self, command: Sequence[str] = NODE) -> Iterator['_Run']:
        """Run a node that is active, and a sleeper; leave it when it has ended."""
        driver = rclpy.create_node('bench_driver', start_parameter_services=False)
        run = _Run(driver)
        try:
            with ExitStack() as stack:
                child = stack.enter_context(ChildNode(self._arguments, command))
                change_all(driver, {'/actuator': child}, Transition.TRANSITION_CONFIGURE)
                run.queue = stack.enter_context(sleeper(self.parameters))
                change_all(driver, {'/actuator': child}, Transition.TRANSITION_ACTIVATE)
                yield run
                child.check()
                code = child.stop()
                if code:
                    raise Failure(f'the node ended with code {code}; {child.last_line}')
                run.recording = child.recording
        finally:
            driver.destroy_node()


class _Run:
    """A node that ran: its recording, and the sleeper that ran beside it."""

    def __init__(self, driver: Node):
        self.driver = driver
        self.recording = Path()
        self.queue = None

    def values(self, part: str) -> dict[str, str]:
        """Return the last values of a status."""
        return last_values(self.recording, part)

    def case(
        self, name: str, latency: DurationHistogram | None = None, remark: str = ''
    ) -> Case:
        """Return the figures."""
        values = self.values('Real time')
        lateness, execution = (
            tuple(float(values[f'{kind}_p{percent:g}']) for percent in PERCENTILES)
            for kind in ('lateness', 'execution'))
        node = Lateness(lateness, float(values['lateness_max']), int(values['ticks']),
                        int(values['overruns']))
        return Case(name, _of_sleeper(self.queue), node, execution, latency, remark)


def _of_sleeper(queue) -> Lateness:
    lateness, ticks, missed = queue.get(timeout=PATIENCE)
    return Lateness(
        tuple(lateness.percentile(percent) / 1e3 for percent in PERCENTILES),
        lateness.maximum / 1e3, ticks, missed)
