# SPDX-License-Identifier: Apache-2.0
"""
The speed of a step as a ratio to a bare loop of the same run, kept for each commit.

Times say what a machine was doing; ratios of one run, piece by piece, stay within some ten per
cent on a shared machine. One JSON object a line: commit, processor, ratios.
"""

import copy
from dataclasses import asdict, dataclass
import json
import math
from pathlib import Path
import statistics
import subprocess

from hydra_actuator.actuator import Actuator
from hydra_actuator.benchmark import drive, processor_time, repeat_sweep, WARM_UP
from hydra_actuator.parameters import Parameters
from hydra_actuator.parameters.options import EVERYTHING
from hydra_actuator.stages import plain_arrays, repeat_limit
import llvmlite.binding

TOLERANCE = 1.3        # times the ratio on record
PIECES, TICKS = 60, 3
PAPER = {'tank.pressure': 0.0}
UNKNOWN = 'unknown'


@dataclass(frozen=True)
class Record:
    """Ratios to the bare loop by name, of a commit on a processor."""

    commit: str
    processor: str
    ratios: dict[str, float]


def measure() -> Record:
    """Time the bare loop, the bare sweep, the paper's step and everything's in turn."""
    actuators = {
        'step, paper': Actuator(Parameters().replace(PAPER)),
        'step, everything': Actuator(Parameters().replace({**PAPER, **EVERYTHING}))}
    for actuator in actuators.values():
        drive(actuator, math.ceil(WARM_UP / actuator.period))
    plain = actuators['step, paper']
    count = TICKS * plain.steps_per_period
    bare = (plain._model, copy.deepcopy(plain._state), plain._passes)
    loop = plain_arrays(plain._model, plain._state)
    works = {
        'sweep': lambda: repeat_sweep(*bare, count),
        **{name: lambda actuator=actuator: drive(actuator, TICKS)
           for name, actuator in actuators.items()}}
    repeat_limit(*loop, 1)
    repeat_sweep(*bare, 1)
    ratios = {name: [] for name in works}
    for _ in range(PIECES):
        limit = processor_time(repeat_limit, *loop, count)
        for name, work in works.items():
            ratios[name].append(processor_time(work) / limit)
    return Record(_commit(), llvmlite.binding.get_host_cpu_name(),
                  {name: round(statistics.median(column), 2) for name, column in ratios.items()})


def read(file: Path) -> list[Record]:
    """Return the records of a file, none if there is no such file."""
    if not file.exists():
        return []
    return [Record(**json.loads(line)) for line in file.read_text().splitlines() if line]


def last(records: list[Record], processor: str) -> Record | None:
    """Return the last record of a processor's kind."""
    return next((r for r in reversed(records) if r.processor == processor), None)


def append(file: Path, record: Record) -> None:
    """Add a record to a file."""
    with file.open('a') as stream:
        stream.write(json.dumps(asdict(record)) + '\n')


def _commit() -> str:
    """Return the short name of the commit this source is of."""
    try:
        return subprocess.run(
            ['git', 'describe', '--always', '--dirty'], cwd=Path(__file__).parent,
            capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return UNKNOWN
