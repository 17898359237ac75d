# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator info RECORDING`: what a recording holds, finished or not."""

from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from datetime import datetime, UTC
import json
from pathlib import Path
import tempfile

SUMMARY = 'what a recording holds'

# Stamps below this are simulated time, which starts at zero or one second [ns].
_FIRST_WALL_STAMP = 365 * 86_400 * 10**9


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('recording', help='a recording directory, or one MCAP file')
    parser.add_argument('--parameters', action='store_true',
                        help='all parameters, as a ROS parameter file')


def run(arguments: Namespace) -> int:
    """Print the description; RecordingError for anything that is no recording."""
    from hydra_actuator.recording.reader import load_recording

    recording = load_recording(arguments.recording)
    for line in describe(recording):
        print(line)
    if arguments.parameters:
        print()
        print(recording.custom_data.get('parameters', '').rstrip())
    return 0


def describe(recording) -> Iterator[str]:
    """Yield the lines of the description of a Recording."""
    size = sum(path.stat().st_size for path in recording.files)
    count = len(recording.files)
    yield f'recording   {recording.path}'
    yield f'finished    {"yes" if recording.finished else "no: its end is missing"}'
    yield f'start       {_start(recording.start_ns)}'
    yield f'duration    {(recording.end_ns - recording.start_ns) / 1e9:.3f} s'
    yield f'size        {size / 1e6:.2f} MB in {count} file{"s" if count > 1 else ""}'
    if count > 1:
        yield from _files(recording)
    yield f'dropped     {_dropped(recording)}'
    yield f'source      {recording.custom_data.get("source", "unknown")}'
    yield f'versions    {_versions(recording.custom_data.get("versions", ""))}'
    yield ''
    yield from _topics(recording)
    yield ''
    yield from _parameters(recording.custom_data.get('parameters', ''))


def _files(recording) -> Iterator[str]:
    """Yield a line per file: size, and whether it is finished."""
    from hydra_actuator.recording.scan import scan

    for path in recording.files:
        finished = '' if scan(path).finished else ', not finished'
        yield f'  {path.name}  {path.stat().st_size / 1e6:.2f} MB{finished}'


def _dropped(recording) -> str:
    """Return how many messages the recorder dropped, by its last word on it."""
    for message in reversed(recording.diagnostics):
        for status in message['status']:
            values = {pair['key']: pair['value'] for pair in status['values']}
            if status['name'].endswith(': Recorder') and 'dropped' in values:
                return f'{values["dropped"]} messages'
    return 'none told'


def _start(stamp_ns: int) -> str:
    if stamp_ns < _FIRST_WALL_STAMP:
        return f'{stamp_ns / 1e9:.3f} s of simulated time'
    return datetime.fromtimestamp(stamp_ns / 1e9, UTC).strftime('%Y-%m-%d %H:%M:%S UTC')


def _versions(text: str) -> str:
    """Return recorded versions as `name version, ...`."""
    try:
        versions = json.loads(text)
        return ', '.join(f'{name} {version}' for name, version in versions.items())
    except (ValueError, AttributeError):
        return 'unknown'


def _topics(recording) -> Iterator[str]:
    """Yield a table of the topics."""
    rows = [('topic', 'messages', 'rate', 'type')]
    for name, topic in recording.topics.items():
        stamps = recording.series(name).stamps
        span = (stamps.max() - stamps.min()) / 1e9 if topic.count > 1 else 0.0
        rate = f'{(topic.count - 1) / span:.1f} Hz' if span > 0 else '-'
        rows.append((name, str(topic.count), rate, topic.type))
    widths = [max(map(len, column)) for column in zip(*rows)]
    for name, count, rate, kind in rows:
        yield f'{name:<{widths[0]}}  {count:>{widths[1]}}  {rate:>{widths[2]}}  {kind}'


def _parameters(text: str) -> Iterator[str]:
    """Yield the parameters that differ from this version's defaults."""
    from hydra_actuator.parameters import definitions, ParameterError

    try:
        values = _read(text)
        sections = values.get('sections.names', ())
        known = definitions(tuple(sections))
    except (ParameterError, TypeError) as error:
        yield f'parameters  not readable: {error}' if text else 'parameters  not recorded'
        return
    changed = []
    for name, value in values.items():
        value = tuple(value) if isinstance(value, list) else value
        if name not in known:
            changed.append(f'  {name} = {value}  (not a parameter of this version)')
        elif value != known[name].default:
            changed.append(f'  {name} = {value}  (default {known[name].default})')
    yield 'parameters that differ from the defaults' if changed else 'parameters  all defaults'
    yield from changed


def _read(text: str) -> dict[str, object]:
    """Return the values of a parameter file's text."""
    from hydra_actuator.parameters import ParameterError, read_parameter_file

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, 'parameters.yaml')
        path.write_text(text, 'utf-8')
        try:
            return read_parameter_file(path)
        except ParameterError as error:
            raise ParameterError(str(error).removeprefix(f'{path}: ')) from None
