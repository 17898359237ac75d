# SPDX-License-Identifier: Apache-2.0
"""The linear response about the valve's null is that of the distributed model."""

from pathlib import Path

from hydra_actuator import load_parameters
from hydra_actuator.verification import spool_response
from hydra_actuator.verification.case import failures
import pytest

CONFIG = Path(__file__).parents[2] / 'config'


def test_gain_and_phase_are_exact_at_all_eight_frequencies():
    assert not failures(spool_response.spool_response())


def test_the_response_is_that_of_the_file_of_the_paper():
    assert spool_response.paper_parameters() == load_parameters(CONFIG / 'paper.yaml')


def test_slow_response_is_flow_gain_over_area_less_the_springs_share():
    p = spool_response.paper_parameters()
    exact = abs(spool_response.exact_response(p, 0.01))
    # at rest the spring's force is carried by compressed oil: v falls to 0 with the frequency
    # only far below k/(load stiffness); between, no-load speed K/A at the density of 10.5 MPa
    flow_gain = 0.62 * 0.03 * (2.0 * 10.5e6 / 860.0) ** 0.5 / (1.0 + 10.5e6 / 1.4534e9)
    oil = 2.0 * 1e-6 * 1.4534e9 * (1.0 + 10.5e6 / 1.4534e9) / (0.2e-3 + 0.2 * 2.0106193e-4)
    assert exact == pytest.approx(flow_gain / 1e-3 * oil / (oil + 2e5), rel=1e-6)


def test_response_does_not_depend_on_the_mesh_being_even():
    p = spool_response.paper_parameters().replace({'line_1.length': 0.23, 'line_2.length': 0.23})
    exact = spool_response.exact_response(p, 300)
    assert spool_response.solver_response(p, 300) == pytest.approx(exact, rel=2e-4)
