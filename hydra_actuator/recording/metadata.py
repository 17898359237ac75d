# SPDX-License-Identifier: Apache-2.0
"""
The text of a recording's metadata.yaml, version 9, and reading it back.

Field by field what rosbag2 of Jazzy writes (rosbag2_storage, bag_metadata and yaml). Written by
hand because it is renewed twice a second: what does not change is put together once. Strings are
double-quoted on one line, so that yaml-cpp and PyYAML read any text back unchanged.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
import json
from pathlib import Path
import re
from textwrap import indent

from hydra_actuator.recording.definitions import type_hashes
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.topics import Topic
import yaml

FILE_NAME = 'metadata.yaml'
ROOT = 'rosbag2_bagfile_information'
VERSION = 9
ROS_DISTRO = 'jazzy'

# What rosbag2 writes as the start of a recording that holds no message.
NO_START = 2**63 - 1

# YAML allows these in a text only as escapes, which JSON leaves out.
_UNPRINTABLE = re.compile('[\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]')


@dataclass(frozen=True)
class FileInformation:
    """One file of a recording; times [ns], both None while it holds no message."""

    path: str
    start_ns: int | None
    end_ns: int | None
    message_count: int


class BagMetadata:
    """The metadata of one recording, made again from counts whenever asked."""

    def __init__(self, topics: Sequence[Topic], custom_data: Mapping[str, str]):
        self._topics = [(topic.name, _topic_yaml(topic)) for topic in topics]
        self._custom_data = ''.join(
            f'  {quoted(key)}: {quoted(value)}\n' for key, value in custom_data.items()
        )

    def information(self, files: Sequence[FileInformation], counts: Mapping[str, int]) -> str:
        """Return the YAML mapping; `counts` is messages by topic."""
        start, duration = _span(files)
        topics = ''.join(f'{text}    message_count: {counts.get(name, 0)}\n'
                         for name, text in self._topics)
        paths = ''.join(f'  - {quoted(file.path)}\n' for file in files)
        custom = f'custom_data:\n{self._custom_data}' if self._custom_data else 'custom_data: ~\n'
        return (
            f'version: {VERSION}\n'
            'storage_identifier: mcap\n'
            f'duration:\n  nanoseconds: {duration}\n'
            f'starting_time:\n  nanoseconds_since_epoch: {start}\n'
            f'message_count: {sum(file.message_count for file in files)}\n'
            f'topics_with_message_count:\n{topics}'
            'compression_format: ""\n'
            'compression_mode: ""\n'
            f'relative_file_paths:\n{paths}'
            f'files:\n{_indented("".join([_file_yaml(file) for file in files]))}'
            f'{custom}'
            f'ros_distro: {ROS_DISTRO}\n'
        )

    def text(self, files: Sequence[FileInformation], counts: Mapping[str, int]) -> str:
        """Return the whole of metadata.yaml."""
        return f'{ROOT}:\n{_indented(self.information(files, counts))}'


def quoted(text: str) -> str:
    """Return a text as a YAML scalar in double quotes, on one line."""
    return _UNPRINTABLE.sub(
        lambda match: f'\\u{ord(match[0]):04x}', json.dumps(text, ensure_ascii=False)
    )


def read_metadata(directory: Path) -> dict:
    """Return what metadata.yaml of a recording says; RecordingError if it says nothing."""
    path = directory / FILE_NAME
    try:
        with path.open(encoding='utf-8') as file:
            content = yaml.load(file, getattr(yaml, 'CSafeLoader', yaml.SafeLoader))
        return content[ROOT]
    except (OSError, UnicodeDecodeError) as error:
        raise RecordingError(f'{path} cannot be read: {error}') from None
    except (yaml.YAMLError, KeyError, TypeError):
        raise RecordingError(f'{path} is not the metadata of a recording') from None


def mcap_files(directory: Path) -> list[Path]:
    """Return the MCAP files of a recording, NAME_2 before NAME_10, listed or not."""
    def key(path: Path) -> tuple[str, int]:
        name, number = re.fullmatch(r'(.*?)([0-9]*)', path.stem, re.DOTALL).groups()
        return name, int(number or 0)

    return sorted(directory.glob('*.mcap'), key=key)


def _span(files: Sequence[FileInformation]) -> tuple[int, int]:
    """Return (start, duration) [ns] of all files together."""
    starts = [file.start_ns for file in files if file.start_ns is not None]
    ends = [file.end_ns for file in files if file.end_ns is not None]
    return (min(starts), max(ends) - min(starts)) if starts else (NO_START, 0)


@lru_cache(4096)
def _file_yaml(file: FileInformation) -> str:
    """Return a file's entry in the list of files."""
    start, duration = _span([file])
    return (
        f'- path: {quoted(file.path)}\n'
        f'  starting_time:\n    nanoseconds_since_epoch: {start}\n'
        f'  duration:\n    nanoseconds: {duration}\n'
        f'  message_count: {file.message_count}\n'
    )


def _indented(text: str) -> str:
    """Return whole lines, none of them empty, two further in: there may be thousands."""
    return f'  {text}'.replace('\n', '\n  ').removesuffix('  ')


def _topic_yaml(topic: Topic) -> str:
    """Return a topic's entry but for its last line, the count."""
    return (
        '  - topic_metadata:\n'
        f'      name: {quoted(topic.name)}\n'
        f'      type: {topic.type}\n'
        '      serialization_format: cdr\n'
        '      offered_qos_profiles:\n'
        f'{indent(topic.offered_qos_profiles(), " " * 8)}\n'
        f'      type_description_hash: {type_hashes()[topic.type]}\n'
    )
