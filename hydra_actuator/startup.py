# SPDX-License-Identifier: Apache-2.0
"""What a start takes, from a new interpreter to the first step, without and with kept kernels."""

from dataclasses import dataclass
import json
import os
import subprocess
import sys
import tempfile
import time

PROGRAM = """
import json, resource, time
marks = {'interpreter': time.process_time()}
import numba
marks['import of numba'] = time.process_time()
from hydra_actuator.actuator import Actuator
from hydra_actuator.kernels import compilations
marks['import of the actuator'] = time.process_time()
actuator = Actuator()
marks['kernels and state'] = time.process_time()
actuator.tick_once(0.0, 0.0, 0.0)
marks['first period'] = time.process_time()
print(json.dumps([marks, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
                  compilations()]))
"""


@dataclass(frozen=True)
class Startup:
    """
    Processor times [s] of a start's parts in their order, time by the clock [s], memory [MB].

    compiled: how many kernels were not found on disk.
    """

    times: dict[str, float]
    elapsed: float
    memory: float
    compiled: int

    @property
    def total(self) -> float:
        """Processor time [s] from the interpreter's start to the end of the first period."""
        return sum(self.times.values())


def measure_startup() -> tuple[Startup, Startup]:
    """Start a process twice, with an empty cache and with the one that leaves: (cold, warm)."""
    with tempfile.TemporaryDirectory() as cache:
        return measure_start(cache), measure_start(cache)


def measure_start(cache: str) -> Startup:
    """Start a process that keeps its kernels in a directory, and step once."""
    began = time.perf_counter()
    output = subprocess.run(
        [sys.executable, '-c', PROGRAM], env=os.environ | {'HYDRA_ACTUATOR_CACHE': cache},
        stdout=subprocess.PIPE, text=True, check=True).stdout
    elapsed = time.perf_counter() - began
    marks, memory, compiled = json.loads(output)
    before, times = 0.0, {}
    for name, mark in marks.items():
        times[name], before = mark - before, mark
    return Startup(times, elapsed, memory, compiled)
