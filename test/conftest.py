# SPDX-License-Identifier: Apache-2.0
"""What holds for all tests: ROS messages check the types of their fields."""

import os
import shutil
import subprocess

from hypothesis import HealthCheck, settings
import pytest

# Read when a message is first imported, here and in the processes that tests start.
os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'


# How long an example takes says nothing here.
settings.register_profile(
    'untimed', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('untimed')


@pytest.fixture
def make_disk(tmp_path):
    """Give file systems of some megabytes, where this process may mount them."""
    places = []

    def make(megabytes):
        place = tmp_path / f'disk_{len(places)}'
        place.mkdir()
        command = ['mount', '-t', 'tmpfs', '-o', f'size={megabytes}m', 'tmpfs', str(place)]
        if shutil.which('mount') is None or subprocess.run(
                command, capture_output=True).returncode:
            pytest.skip('a file system cannot be mounted here')
        places.append(place)
        return place
    yield make
    for place in places:
        subprocess.run(['umount', '-l', str(place)], check=True)
