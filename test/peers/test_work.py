# SPDX-License-Identifier: Apache-2.0
"""The line all solvers compute: our answer is exact, and the judge sees a wrong one."""

from hydra_actuator.peers.inp import write_inp
from hydra_actuator.peers.ours import OurLine, run_ours
from hydra_actuator.peers.work import GRAVITY, judge, rise_error, WORK
import numpy as np
import pytest

NODES = WORK['cells'] + 1
RISE = WORK['wave_speed'] * WORK['velocity'] / GRAVITY


def trace(rise, closed=5):
    """Return a head that rises at once, and falls when the wave is back."""
    head = np.full(4 * NODES, 150.0)
    head[closed:closed + 2 * WORK['cells']] += rise
    return head


def test_the_judge_reads_the_rise_of_the_first_plateau():
    assert rise_error(trace(RISE), 5, NODES, RISE) == pytest.approx(0.0, abs=1e-12)
    assert rise_error(trace(0.9 * RISE), 5, NODES, RISE) == pytest.approx(-0.1)


def test_node_updates_count_all_nodes_of_all_steps():
    found = judge({'nodes': NODES, 'steps': 1000, 'seconds': 0.5, 'velocity': 0.5, 'closed': 5,
                   'wave_speed': 1219.2, 'head': trace(RISE).tolist(), 'version': '1'})
    assert found.updates == NODES * 1000 / 0.5


@pytest.mark.parametrize('passes', [2, 1])
def test_our_line_rises_by_its_own_exact_answer(passes):
    found = run_ours(100, passes)
    # Interpolation of a front one node wide rings a little about its plateau's mean.
    assert abs(found.error) < 1e-6
    assert found.updates > 0.0


def test_the_nonlinear_rise_is_a_thousandth_above_joukowskys():
    assert OurLine().exact_rise / RISE == pytest.approx(1.0012, abs=1e-4)


def test_the_network_file_draws_what_flows(tmp_path):
    write_inp(WORK, str(tmp_path / 'line.inp'))
    text = (tmp_path / 'line.inp').read_text()
    drawn = float(text.split(' S 0 ')[1].split()[0])
    assert drawn == pytest.approx(1e3 * 0.25 * np.pi * 0.3**2 * 0.5)
