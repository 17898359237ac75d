# SPDX-License-Identifier: Apache-2.0
"""
What the recorder of a real node takes in and writes, and what that costs.

    start a node that records -> for some seconds command it at 1 kHz over DDS -> stop it
    -> count what its recording holds and what was dropped, beside the ticks the solver told of

`in` is the sum of what is in the file and what the recorder counted as dropped; that nothing is
lost before it, the ticks show. The processor time of the writer's thread is its own word, once a
second in its status.
"""

from dataclasses import dataclass
from pathlib import Path
import time

from hydra_actuator.errors import Failure
from hydra_actuator.recording.reader import load_recording, Recording
from hydra_actuator.ros.child import ChildNode
from hydra_actuator.ros.driver import SineSender
from hydra_actuator.ros.measured import (
    change_all,
    ground,
    Progress,
    recording_into,
    statuses_over_time,
)
from lifecycle_msgs.msg import Transition
import rclpy

FREQUENCY = 50.0


@dataclass(frozen=True)
class RecorderFigures:
    """
    What became of the messages of one run.

    duration [s]: of the recording; ticks: of the solver, when it last told of itself; recorded:
    messages in the files by topic; dropped: by topic; size [byte]: of the files; most_waiting
    [byte]: in the queue; writer, node: share of a core.
    """

    duration: float
    ticks: int
    dropped: dict[str, int]
    recorded: dict[str, int]
    size: int
    most_waiting: int
    writer: float
    node: float


def measure_recorder(
    duration: float, configs: list[str], output: Path, progress: Progress
) -> RecorderFigures:
    """
    Run a node for `duration` [s] and return the figures of its recording.

    configs: parameter files; output: folder of the recording. Raises Failure if the node fails.
    """
    with ground():
        driver = rclpy.create_node('bench_driver', start_parameter_services=False)
        sender = SineSender(driver, FREQUENCY)
        try:
            with ChildNode(recording_into(output, configs)) as child:
                change_all(driver, {'/actuator': child}, Transition.TRANSITION_CONFIGURE)
                change_all(driver, {'/actuator': child}, Transition.TRANSITION_ACTIVATE)
                sender.start()
                before, begin = child.processor_time, time.monotonic()
                while (elapsed := time.monotonic() - begin) < duration:
                    progress(elapsed / duration)
                    child.check()
                    time.sleep(0.1)
                share = (child.processor_time - before) / elapsed
                sender.stop()
                code = child.stop()
                if code:
                    raise Failure(f'the node ended with code {code}; {child.last_line}')
                return figures(load_recording(child.recording), share)
        finally:
            sender.stop()
            driver.destroy_node()


def figures(recording: Recording, node: float) -> RecorderFigures:
    """Return the figures of a recording; node: share of a core that the whole process took."""
    told = statuses_over_time(recording, 'Recorder')
    ticks = statuses_over_time(recording, 'Real time')
    told = [one for one in told if 'writer_processor_time' in one[1]]
    if len(told) < 2 or not ticks:
        raise Failure(f'{recording.path} holds fewer than two statuses of its recorder')
    (first, start), (last, end) = told[0], told[-1]
    spent = float(end['writer_processor_time']) - float(start['writer_processor_time'])
    return RecorderFigures(
        duration=(recording.end_ns - recording.start_ns) * 1e-9, ticks=int(ticks[-1][1]['ticks']),
        dropped={name.removeprefix('dropped: '): int(count) for name, count in end.items()
                 if name.startswith('dropped: ')},
        recorded={name: one.count for name, one in recording.topics.items() if one.count},
        size=sum(path.stat().st_size for path in recording.files),
        most_waiting=int(end['most_waiting_bytes']), writer=spent / ((last - first) * 1e-9),
        node=node)


def lines(found: RecorderFigures) -> list[str]:
    """Return what to print of the figures."""
    lost = sum(found.dropped.values())
    told = [
        f'{found.duration:.1f} s, {found.ticks} ticks when last told; '
        f'{sum(found.recorded.values())} messages in the file, '
        f'{sum(found.recorded.values()) / found.duration:.0f} a second, {lost} dropped',
        f'{found.size / 1e6:.1f} MB, {found.size / found.duration / 1e6:.2f} MB a second; at most '
        f'{found.most_waiting / 1e6:.2f} MB waited for the writer',
        f'writer thread {found.writer:.1%} of a core, the whole node {found.node:.1%}',
        f'{"topic":<34}{"in":>10}{"dropped":>10}{"in file":>10}{"a second":>10}',
    ]
    for name, count in found.recorded.items():
        gone = found.dropped.get(name, 0)
        told.append(f'{name:<34}{count + gone:10}{gone:10}{count:10}'
                    f'{count / found.duration:10.1f}')
    return told
