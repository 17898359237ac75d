# SPDX-License-Identifier: Apache-2.0
"""
What stands in a file before its first chunk: header, schemas, channels, custom data, checksums.

MCAP's own checksums cover chunks and summary only. The last record of the opening, a metadata
record, has those of the definitions (schemas and channels) and of the custom data that stand
right before it, each as `length crc32`. A file cut off has no summary, and without them a flipped
bit could turn a topic into another.
"""

from collections.abc import Iterable, Mapping, Sequence
import zlib

from hydra_actuator import __version__
from hydra_actuator.recording.definitions import definition, ENCODING, type_hashes
from hydra_actuator.recording.topics import Topic
from mcap.data_stream import RecordBuilder
from mcap.records import Channel, Header, McapRecord, Schema

MAGIC = b'\x89MCAP0\r\n'
HEADER = Header(profile='ros2', library=f'hydra_actuator {__version__}')
CUSTOM_DATA = 'hydra_actuator'
CHECKSUMS = 'hydra_actuator.checksums'


def checksums(definitions: bytes, custom_data: bytes) -> dict[str, str]:
    """Return the entries of the record that vouches for the records before it."""
    return {
        'definitions': f'{len(definitions)} {zlib.crc32(definitions)}',
        'custom_data': f'{len(custom_data)} {zlib.crc32(custom_data)}',
    }


def parts_before(
    opening: bytes, end: int, entries: Mapping[str, str]
) -> dict[str, bytes | None]:
    """Return what stands before the record of checksums at `end`; None for what disagrees."""
    parts: dict[str, bytes | None] = {}
    for name in ('custom_data', 'definitions'):
        length, _, checksum = entries.get(name, '').partition(' ')
        begin = end - int(length) if length.isascii() and length.isdecimal() else end
        part = opening[max(begin, 0): end]
        parts[name] = part if checksum == str(zlib.crc32(part)) else None
        end = begin
    return parts


def definition_records(topics: Sequence[Topic]) -> list[McapRecord]:
    """Return the schemas, each once, then the channels."""
    types = list(dict.fromkeys(topic.type for topic in topics))
    schemas = [
        Schema(id=number + 1, name=name, encoding=ENCODING, data=definition(name).encode())
        for number, name in enumerate(types)
    ]
    channels = [
        Channel(
            id=number + 1, topic=topic.name, message_encoding='cdr',
            schema_id=types.index(topic.type) + 1,
            metadata={
                'offered_qos_profiles': topic.offered_qos_profiles(),
                'topic_type_hash': type_hashes()[topic.type],
            },
        )
        for number, topic in enumerate(topics)
    ]
    return [*schemas, *channels]


def encoded(records: Iterable[McapRecord]) -> bytes:
    """Return records as they stand in a file."""
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return builder.end()
