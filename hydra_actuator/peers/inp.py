# SPDX-License-Identifier: Apache-2.0
"""The line as an EPANET file: reservoir, pipe, valve, what is drawn behind it; l/s, mm, m."""

import math

GRAVITY = 9.80665


def write_inp(work: dict, path: str) -> None:
    """Write the network of a work; the valve's loss takes half the head."""
    loss = 0.5 * work['head'] / (work['velocity'] ** 2 / (2.0 * GRAVITY))
    drawn = 1e3 * work['velocity'] * 0.25 * math.pi * work['diameter'] ** 2
    diameter = 1e3 * work['diameter']
    lines = [
        '[JUNCTIONS]', ' N 0 0', f' S 0 {drawn}', '[RESERVOIRS]', f' R {work["head"]}',
        '[PIPES]', f' P R N {work["length"]} {diameter} 0.0001 0 Open',
        '[VALVES]', f' V N S {diameter} TCV {loss} 0',
        '[OPTIONS]', ' Units LPS', ' Headloss D-W', ' Accuracy 0.00001', '[TIMES]',
        ' Duration 0', '[COORDINATES]', ' N 1 0', ' R 0 0', ' S 2 0', '[END]', '']
    with open(path, 'w', encoding='utf-8') as file:
        file.write('\n'.join(lines))
