# SPDX-License-Identifier: Apache-2.0
"""
A recording as labelled arrays: xarray datasets of the states and of the field, with units.

    states  over `time` [s] and `station`: position, velocity, effort, load_force; spool_position
            and spool_command by `spool`; pressure and flow_velocity by `station`; what is known
            of cavities, by `domain` where it is by domain
    field   over `time` [s] and `node`: pressure and flow_velocity, with the place `x` and the
            `domain` of each node

Names and units are those of `channels`. Time counts from the first joint state in both; `stamp` is
the instant itself. The commands are those the solver took, held until the next. Places are those
along the streamline; nodes of the chambers are placed as at mid-stroke.
"""

from typing import TYPE_CHECKING

from hydra_actuator.channels import DOMAINS
from hydra_actuator.recording.errors import RecordingError
import numpy as np

if TYPE_CHECKING:
    from hydra_actuator.recording.reader import Recording
    import xarray

_ABSOLUTE = {'long_name': 'absolute pressure'}
_VELOCITY = {'long_name': 'flow velocity, positive from pump to tank'}
_PLACE = {'units': 'm', 'long_name': 'place along the streamline, from pump to tank'}


def states(recording: 'Recording') -> 'xarray.Dataset':
    """Return the states of a recording, one instant per joint state."""
    import xarray

    channels, rows = recording.channels, recording.rows
    units = {channel.name: channel.unit for channel in channels.table()}
    spools = slice(channels.SPOOL_1, channels.SPOOL_1 + channels.spools)
    data = {
        name: (('time',), rows[:, column], {'units': units[name]})
        for name, column in [
            ('position', channels.POSITION), ('velocity', channels.VELOCITY),
            ('effort', channels.EFFORT), ('load_force', channels.LOAD_FORCE)]
    }
    data['spool_position'] = (('time', 'spool'), rows[:, spools], {'units': 'm'})
    data['spool_command'] = (('time', 'spool'), _held(recording), {
        'units': '1', 'long_name': 'command in force, 1 is full spool'})
    data['pressure'] = (('time', 'station'), rows[:, channels.pressure],
                        {'units': 'Pa', **_ABSOLUTE})
    data['flow_velocity'] = (('time', 'station'), rows[:, channels.flow_velocity],
                             {'units': 'm/s', **_VELOCITY})
    if len(recording.cavities[0]):
        data |= {name: (('time',), rows[:, getattr(channels, name)],
                        {'units': unit.replace('-', '1')})
                 for name, unit in channels.CAVITY_SCALARS}
        data['domain_cavity_volume'] = (
            ('time', 'domain'), rows[:, channels.domain_cavities], {'units': 'm^3'})
    places = recording.section_positions
    if len(places) != len(channels.section_names):
        places = np.full(len(channels.section_names), np.nan)
    return xarray.Dataset(data, {
        **_times(recording.time, recording.row_stamps),
        'station': ('station', list(channels.section_names)),
        'x': ('station', places, _PLACE),
        'spool': ('spool', np.arange(1, channels.spools + 1)),
        **({'domain': ('domain', list(DOMAINS))} if 'domain_cavity_volume' in data else {}),
    }, _about(recording))


def field(recording: 'Recording') -> 'xarray.Dataset':
    """Return the field of a recording; RecordingError if its nodes are not told."""
    import xarray

    values = recording.field
    places, labels = recording.field_positions, recording.field_labels
    nodes = values.shape[1] if len(values) else len(places)
    if not nodes == len(places) == len(labels):
        raise RecordingError(f'{recording.path}: its field has {nodes} nodes, and its run data '
                             f'tell the places of {len(places)}')
    values = values if len(values) else np.empty((0, nodes, 2), np.float32)
    return xarray.Dataset({
        'pressure': (('time', 'node'), values[:, :, 0], {'units': 'Pa', **_ABSOLUTE}),
        'flow_velocity': (('time', 'node'), values[:, :, 1], {'units': 'm/s', **_VELOCITY}),
    }, {
        **_times(recording.field_time, recording.field_stamps),
        'x': ('node', places, _PLACE),
        'domain': ('node', labels),
    }, _about(recording))


def _times(time: np.ndarray, stamps: np.ndarray) -> dict:
    return {
        'time': ('time', time, {'units': 's', 'long_name': 'time since the first joint state'}),
        'stamp': ('time', stamps.astype('datetime64[ns]')),
    }


def _held(recording: 'Recording') -> np.ndarray:
    """Return the spool commands in force at each row, 0 before the first."""
    spools = recording.channels.spools
    stamps, values = recording.applied
    if not len(stamps):
        return np.zeros((len(recording.rows), spools))
    order = np.argsort(stamps, kind='stable')
    commands = np.vstack([np.zeros(spools), values[order, 1: 1 + spools]])
    return commands[np.searchsorted(stamps[order], recording.row_stamps, 'right')]


def _about(recording: 'Recording') -> dict[str, str]:
    """Return the attributes: where the arrays are from, and with what they were made."""
    told = {key: recording.custom_data[key] for key in ('source', 'versions', 'parameters')
            if key in recording.custom_data}
    return {'recording': recording.path.resolve().name,
            'finished': 'yes' if recording.finished else 'no', **told}
