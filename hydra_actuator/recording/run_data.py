# SPDX-License-Identifier: Apache-2.0
"""
The custom data of a recording: with what it was made, and what its arrays mean.

    source             'node' or 'simulate'
    parameters         a ROS parameter file with all values
    versions           JSON, name -> version
    section_positions  JSON, place of each section along the streamline [m]
    field_positions    JSON, place of each node of the field along the streamline [m]
    field_labels       JSON, domain of each node of the field
"""

from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
import json
import platform

from hydra_actuator import __version__

_PACKAGES = ('numpy', 'numba', 'mcap', 'rclpy')


def run_data(
    source: str, parameters: str, section_positions: Sequence[float] = (),
    field_positions: Sequence[float] = (), field_labels: Sequence[str] = (),
) -> dict[str, str]:
    """Return the custom data for a RecordingWriter; sequences may be arrays."""
    return {
        'source': source,
        'parameters': parameters,
        'versions': json.dumps(versions()),
        'section_positions': json.dumps([float(place) for place in section_positions]),
        'field_positions': json.dumps([float(place) for place in field_positions]),
        'field_labels': json.dumps([str(label) for label in field_labels]),
    }


def versions() -> dict[str, str]:
    """Return the versions of what makes the numbers; an absent package is left out."""
    found = {'hydra_actuator': __version__, 'python': platform.python_version()}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
