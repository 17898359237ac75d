# SPDX-License-Identifier: Apache-2.0
"""The line with a closing valve, by TSNet; run by a Python that has it, see work.py."""

import contextlib
from importlib.metadata import version
import io
import json
import sys
import time

from inp import write_inp
import tsnet

CLOSED = 1      # without a closing time it is shut from the first step


def run(work: dict, steps: int) -> tuple:
    """Return the simulated model and the computing time of the simulation [s]."""
    dt = work['length'] / (work['cells'] * work['wave_speed'])
    model = tsnet.network.TransientModel('line.inp')
    model.set_wavespeed(work['wave_speed'])
    model.set_time((steps + 0.5) * dt, dt)
    model.valve_closure('V', [0, 0, 0, 1])
    model = tsnet.simulation.Initializer(model, 0.0, 'DD')
    began = time.process_time()
    model = tsnet.simulation.MOCSimulator(model)
    return model, time.process_time() - began


def main() -> None:
    """Read the work, print what came out as JSON."""
    work = json.loads(sys.argv[1])
    write_inp(work, 'line.inp')
    with contextlib.redirect_stdout(io.StringIO()):
        run(work, 20)
        model, seconds = run(work, work['steps'])
    pipe = model.get_link('P')
    nodes = pipe.number_of_segments + 1
    head = model.get_node('N').head
    print(json.dumps({
        'version': version('tsnet'), 'seconds': seconds, 'steps': len(head) - 1,
        'nodes': nodes, 'velocity': float(pipe.initial_velocity[-1]), 'closed': CLOSED,
        'wave_speed': float(pipe.wavev), 'head': [float(h) for h in head[:4 * nodes]]}))


if __name__ == '__main__':
    main()
