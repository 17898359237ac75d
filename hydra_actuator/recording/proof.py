# SPDX-License-Identifier: Apache-2.0
"""
What the channel numbers of a damaged file mean, and its custom data, as far as that is proved.

A topic's name stands outside of all chunks and their checksums. It is proved by a sound chunk or
summary that repeats it, by the checksums of the opening, or by metadata.yaml where that and the
file say the same byte for byte. With the checksums, metadata.yaml also stands in for an opening
that is lost.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from io import BytesIO
import struct
import zlib

from hydra_actuator.recording.chunks import chunk_records
from hydra_actuator.recording.definitions import definition, type_hashes
from hydra_actuator.recording.opening import (
    CHECKSUMS,
    CUSTOM_DATA,
    definition_records,
    encoded,
    parts_before,
)
from hydra_actuator.recording.salvage import Salvage
from hydra_actuator.recording.scan import RECORD_HEAD, records
from hydra_actuator.recording.topics import Topic
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema
import numpy as np

_UNREADABLE = (struct.error, EndOfFile, UnicodeDecodeError, KeyError, ValueError)


@dataclass(frozen=True)
class Proof:
    """
    What is proved: topics by channel id, and the custom data, None if they are not.

    `own` tells that a writer of this package made the file: its sequence numbers count from 0.
    """

    topics: Mapping[int, Topic]
    custom_data: dict[str, str] | None
    own: bool


def prove(found: Salvage, content: np.ndarray, metadata: Mapping) -> Proof:
    """Return what a file proves together with its metadata.yaml, a mapping, maybe empty."""
    opening = content[: found.first_chunk].tobytes()
    claimed = _Claims(metadata)
    place, sums = _checksums(opening)
    parts = parts_before(opening, place, sums)
    custom = _first_proved(opening, parts['custom_data'], sums.get('custom_data'),
                           claimed.custom_data())
    definitions = _first_proved(opening, parts['definitions'], sums.get('definitions'),
                                claimed.definitions())
    topics = _topics(definitions)
    if found.summary is not None:
        topics |= _topics(content[slice(*found.summary)].tobytes())
    if not topics and found.chunks:
        topics = _repeated(found, content)
    metadata_records = _of(custom, Opcode.METADATA, Metadata)
    data = next((record.metadata for record in metadata_records), None)
    if data is None and CUSTOM_DATA.encode() not in opening:
        data = dict(metadata.get('custom_data') or {})
    return Proof(topics, data, bool(sums))


class _Claims:
    """The records a file would hold if metadata.yaml is right."""

    def __init__(self, metadata: Mapping):
        self._metadata = metadata

    def definitions(self) -> bytes:
        """Return schemas and channels, or nothing where the metadata do not tell."""
        try:
            entries = [entry['topic_metadata']
                       for entry in self._metadata['topics_with_message_count']]
            topics = [_topic(entry['name'], entry['type'], str(entry['offered_qos_profiles']))
                      for entry in entries]
            return encoded(definition_records(topics))
        except (KeyError, TypeError, AttributeError, UnicodeEncodeError):
            return b''

    def custom_data(self) -> bytes:
        """Return the record of custom data."""
        data = self._metadata.get('custom_data') or {}
        try:
            return encoded([Metadata(name=CUSTOM_DATA, metadata=dict(data))])
        except (AttributeError, TypeError, ValueError):
            return b''


def _checksums(opening: bytes) -> tuple[int, dict[str, str]]:
    """Return where the record of checksums begins, and its entries; none if it is damaged."""
    name = CHECKSUMS.encode()
    place = opening.rfind(name) - 4 - RECORD_HEAD.size
    if place < 0:
        return len(opening), {}
    for record in _of(opening[place:], Opcode.METADATA, Metadata):
        if record.name == CHECKSUMS and {'definitions', 'custom_data'} <= record.metadata.keys():
            return place, record.metadata
    return len(opening), {}


def _first_proved(
    opening: bytes, part: bytes | None, checksum: str | None, claimed: bytes
) -> bytes:
    """Return the part of the opening, or the records claimed, whichever are proved."""
    if part:
        return part
    agrees = checksum == f'{len(claimed)} {zlib.crc32(claimed)}'
    return claimed if agrees or (claimed and claimed in opening) else b''


def _repeated(found: Salvage, content: np.ndarray) -> dict[int, Topic]:
    """Return what the sound chunks themselves say, as those of other writers do."""
    parts = []
    for chunk in found.chunks:
        inside = chunk_records(content, chunk.start, chunk.stop)
        parts += [inside[start - RECORD_HEAD.size: stop].tobytes()
                  for opcode, start, stop in records(inside, 0)
                  if opcode in (Opcode.SCHEMA, Opcode.CHANNEL)]
    return _topics(b''.join(dict.fromkeys(parts)))


def _topics(content: bytes) -> dict[int, Topic]:
    """Return the topics of records that are proved; those of strange types are left out."""
    schemas = {schema.id: schema for schema in _of(content, Opcode.SCHEMA, Schema)}
    topics = {}
    for channel in _of(content, Opcode.CHANNEL, Channel):
        schema = schemas.get(channel.schema_id)
        if schema is not None and schema.name in type_hashes() \
                and schema.data.decode() == definition(schema.name):
            topics[channel.id] = _topic(channel.topic, schema.name,
                                        channel.metadata.get('offered_qos_profiles', ''))
    return topics


def _topic(name: str, type_name: str, qos: str) -> Topic:
    return Topic(name, type_name, 'best_effort' if 'best_effort' in qos else 'reliable')


def _of(content: bytes, opcode: Opcode, kind) -> Iterable:
    """Return the records of a kind among those encoded; none from where they are unreadable."""
    found = []
    try:
        for number, start, stop in records(np.frombuffer(content, np.uint8), 0):
            if number == opcode:
                found.append(kind.read(ReadDataStream(BytesIO(content[start:stop]))))
    except _UNREADABLE:
        pass
    return found
