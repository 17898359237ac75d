# SPDX-License-Identifier: Apache-2.0
"""
Whether a wish for DDS security can be granted: a node must never run open where it was to be safe.

Fast DDS built without its security plugins (as in the wheels) ignores the wish where no enclave
is found, and fails deep inside where one is. A build with plugins carries their names.
"""

import mmap
import os
from pathlib import Path

_PLUGIN = b'builtin.PKI-DH'
_LIBRARIES = ('libfastrtps.so', 'libfastdds.so')


def security_wanted() -> bool:
    """Tell whether the environment asks for DDS security."""
    return os.environ.get('ROS_SECURITY_ENABLE', '').lower() == 'true'


def security_missing() -> str:
    """Return why the loaded middleware cannot give security, '' if nothing speaks against it."""
    for path in _loaded_libraries():
        with path.open('rb') as file, mmap.mmap(
                file.fileno(), 0, access=mmap.ACCESS_READ) as content:
            if content.find(_PLUGIN) < 0:
                return f'{path} is built without DDS security'
    return ''


def _loaded_libraries() -> set[Path]:
    """Return the Fast DDS libraries of this process."""
    lines = Path('/proc/self/maps').read_text('utf-8').splitlines()
    paths = {Path(line.split(maxsplit=5)[5]) for line in lines if len(line.split()) > 5}
    return {path for path in paths if path.name.startswith(_LIBRARIES) and path.is_file()}
