# SPDX-License-Identifier: Apache-2.0
"""The columns of a row: each named once, the new ones behind the old."""

from hydra_actuator.channels import Channels, DOMAINS
import numpy as np
import pytest


@pytest.mark.parametrize('sections', [(), ('A',), ('O', 'A', 'tap')])
def test_every_column_has_one_name_in_order(sections):
    channels = Channels(sections)
    table = channels.table()
    assert [one.column for one in table] == list(range(channels.width))
    assert len({one.name for one in table}) == channels.width == len(channels.empty_row())


def test_cavities_stand_behind_what_there_was_and_domains_last():
    channels = Channels(('A', 'B'))
    names = np.array([one.name for one in channels.table()])
    assert names[channels.cavity_volume] == 'cavity_volume'
    assert names[channels.lowest_pressure] == 'lowest_pressure'
    assert names[channels.cavities_collapsed] == 'cavities_collapsed'
    assert channels.cavities.start == channels.flow_velocity.stop
    assert names[channels.domain_cavities].tolist() == [f'cavity_volume.{d}' for d in DOMAINS]
