# SPDX-License-Identifier: Apache-2.0
"""
The line with a closing valve, by RTHYM-MOC; run by a Python that has it, see work.py.

Its units are the foot and the gallon. The valve is a junction whose demand ends within a step. Its
wave speed in a rigid pipe is 4000 ft/s; the step makes that 200 reaches at Courant 1. Without
unsteady friction (k_bru = 0; the default makes this frictionless line swing to twice the rise).
"""

import json
import math
import sys
import time

import numpy as np
import rthym_moc

FOOT, INCH, GALLON_PER_MINUTE = 0.3048, 0.0254, 6.30902e-5
SMOOTH = 1000.0        # Hazen-Williams
AT = 10                # closes after so many steps


def run(work: dict, steps: int) -> tuple[dict, float]:
    """Return results of a fresh solver and the computing time of its run [s]."""
    area = 0.25 * math.pi * work['diameter'] ** 2
    flow = work['velocity'] * area / GALLON_PER_MINUTE
    dt = work['length'] / (work['cells'] * work['wave_speed'])
    solver = rthym_moc.MOCSolver()
    for name, kind, demand in (('R', 'PressureBoundary', 0.0), ('V', 'Junction', flow)):
        node = rthym_moc.NodeInput()
        node.id, node.type, node.elevation, node.head, node.demand = (
            name, kind, 0.0, work['head'] / FOOT, demand)
        solver.add_node(node)
    pipe = rthym_moc.PipeInput()
    pipe.id, pipe.from_node, pipe.to_node = 'P', 'R', 'V'
    pipe.length, pipe.diameter, pipe.roughness = (
        work['length'] / FOOT, work['diameter'] / INCH, SMOOTH)
    pipe.flow_gpm = flow
    solver.add_pipe(pipe)
    solver.set_demand_schedule('V', [(0.0, flow), (AT * dt, flow), ((AT + 1) * dt, 0.0)])
    began = time.process_time()
    found = solver.run(total_time=steps * dt, dt=dt, k_bru=0.0)
    return found, time.process_time() - began


def main() -> None:
    """Read the work, print what came out as JSON."""
    work = json.loads(sys.argv[1])
    found, _ = run(work, 4 * work['cells'])
    head = np.asarray(found['node_head']['V']) * FOOT
    _, seconds = run(work, work['steps'])
    print(json.dumps({
        'version': rthym_moc.__version__, 'seconds': seconds, 'steps': work['steps'],
        'nodes': work['cells'] + 1, 'velocity': work['velocity'],
        'wave_speed': work['wave_speed'], 'closed': AT + 1, 'head': head.tolist()}))


if __name__ == '__main__':
    main()
