# SPDX-License-Identifier: Apache-2.0
"""The line with a closing valve, by PTSNET; run by a Python that has it, see work.py."""

import contextlib
from importlib.metadata import version
import io
import json
import sys
import time

from inp import write_inp
import numpy as np

# It was written for these names, which numpy has no more.
np.int, np.float, np.bool, np.object = int, float, bool, object

from ptsnet.simulation.sim import PTSNETSimulation  # noqa: E402

AT = 10     # closes after so many steps


def run(work: dict, steps: int) -> tuple:
    """Return the simulation and the computing time of its steps [s]."""
    dt = work['length'] / (work['cells'] * work['wave_speed'])
    simulation = PTSNETSimulation(
        'line', 'line.inp', {
            'time_step': dt, 'duration': steps * dt, 'default_wave_speed': work['wave_speed'],
            'wave_speed_method': 'optimal', 'save_results': True, 'show_progress': False,
            'warnings_on': False})
    simulation.define_valve_settings('V', [0.0, AT * dt], [1.0, 0.0])
    simulation.run_step()
    began = time.process_time()
    while not simulation.is_over:
        simulation.run_step()
    return simulation, time.process_time() - began


def main() -> None:
    """Read the work, print what came out as JSON."""
    work = json.loads(sys.argv[1])
    write_inp(work, 'line.inp')
    with contextlib.redirect_stdout(io.StringIO()):
        run(work, 20)
        simulation, seconds = run(work, work['steps'])
        head = simulation['node'].head['N']
        flow = simulation['pipe.start'].flowrate['P']
    area = 0.25 * 3.141592653589793 * work['diameter'] ** 2
    print(json.dumps({
        'version': version('ptsnet'), 'seconds': seconds, 'steps': len(head) - 1,
        'nodes': int(simulation.num_points), 'velocity': float(flow[0]) / area, 'closed': AT,
        'wave_speed': float(simulation.ss['pipe'].wave_speed[0]),
        'head': [float(h) for h in head[:4 * simulation.num_points]]}))


if __name__ == '__main__':
    main()
