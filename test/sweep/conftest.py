# SPDX-License-Identifier: Apache-2.0
"""One small cluster of this machine for all tests of sweeps, and plans that take moments."""

from hydra_actuator.parameters import Parameters
from hydra_actuator.signals import Sine
from hydra_actuator.sweep.design import sample
from hydra_actuator.sweep.execution import Where
from hydra_actuator.sweep.factor import read_factor
from hydra_actuator.sweep.plan import Plan
from hydra_actuator.sweep.run import Drive
import pytest

BASE = Parameters({'solver.cells': 40})


@pytest.fixture(scope='session')
def cluster():
    """Give a cluster of two workers; what a test kills comes back."""
    from distributed import LocalCluster
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, memory_limit=0,
                      dashboard_address=':0', silence_logs='CRITICAL') as cluster:
        yield cluster


@pytest.fixture
def where(cluster):
    return Where(cluster.scheduler_address)


def plan_over(*texts, method='sobol', count=8, base=BASE, duration=0.005):
    """Return a plan over some factors, on a short sine."""
    factors = tuple(read_factor(text, base) for text in texts)
    samples = tuple(map(tuple, sample(method, factors, count)))
    return Plan(base, factors, method, count, 0, Drive(Sine(200.0), duration, 0.0, 1e4), 'sine',
                samples)


@pytest.fixture(scope='session')
def make_plan():
    """Give plans that take moments."""
    return plan_over
