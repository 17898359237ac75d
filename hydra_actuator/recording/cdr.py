# SPDX-License-Identifier: Apache-2.0
"""
Any ROS 2 message between CDR bytes and a dictionary, by the text of its definition.

Plain CDR, version 1, as Fast CDR writes it for ROS 2: a four-byte encapsulation header, then the
fields in order, each primitive aligned to its own size counted from the end of the header; a
string is its length with the closing zero, then the bytes; a sequence is its length, then the
elements. Padding is not defined (Fast CDR leaves what was in memory); here it is zero. rclpy's
`serialize_message` may also append undefined bytes: it estimates the size as if an element
followed the length of an empty sequence. What goes over the network has none of those.

Neglected: wide strings, default values (a field left out is zero), parameter-list encodings.
Bytes and chars are integers here. Speed is not the aim: see `messages` for the frequent types.

Source: OMG DDS-XTypes 1.3, 7.4.1 (plain CDR); docs.ros.org, "About ROS 2 interfaces".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
import re
import struct

from hydra_actuator.recording.definitions import definition, SEPARATOR
from hydra_actuator.recording.errors import RecordingError

HEADER = b'\x00\x01\x00\x00'

_PRIMITIVES = {
    'bool': '?', 'byte': 'B', 'char': 'B', 'uint8': 'B', 'int8': 'b', 'uint16': 'H',
    'int16': 'h', 'uint32': 'I', 'int32': 'i', 'uint64': 'Q', 'int64': 'q', 'float32': 'f',
    'float64': 'd',
}
_FIELD = re.compile(
    r'(?P<type>[A-Za-z][\w/]*)(?:<=\d+)?(?P<array>\[(?P<length>[^\]]*)\])?\s+'
    r'(?P<name>[A-Za-z]\w*)\s*(?P<constant>=)?'
)


class CdrError(RecordingError, ValueError):
    """Bytes are not the message they are said to be, or values do not fit its fields."""


@dataclass(frozen=True)
class Field:
    """One field: a primitive's format, 'string', or a nested type; `length` None = no array."""

    name: str
    type_name: str
    length: int | None = None

    @property
    def format(self) -> str | None:
        return _PRIMITIVES.get(self.type_name)


class _Sink:
    """Bytes after the encapsulation header, growing."""

    def __init__(self, padding: int):
        self.bytes = bytearray()
        self._padding = bytes([padding])

    def align(self, size: int) -> None:
        self.bytes += self._padding * (-len(self.bytes) % size)

    def pack(self, form: str, values) -> None:
        if len(values):
            self.align(struct.calcsize(form))
        self.bytes += struct.pack(f'<{len(values)}{form}', *values)


class _Source:
    """Bytes after the encapsulation header, being read."""

    def __init__(self, data: bytes):
        if len(data) < 4 or data[0] != 0 or data[1] > 1:
            raise CdrError('no plain CDR header')
        self._bytes = memoryview(data)[4:]
        self._order = '<' if data[1] else '>'
        self._at = 0

    def align(self, size: int) -> None:
        self._at += -self._at % size

    def unpack(self, form: str, count: int) -> tuple:
        size = struct.calcsize(form)
        if count:
            self.align(size)
        end = self._at + count * size
        if end > len(self._bytes):
            raise CdrError(f'{count} x {size} bytes wanted, {len(self._bytes) - self._at} left')
        values = struct.unpack_from(f'{self._order}{count}{form}', self._bytes, self._at)
        self._at = end
        return values

    def string(self) -> str:
        (length,) = self.unpack('I', 1)
        (text,) = struct.unpack(f'{length}s', bytes(self.unpack('B', length)))
        try:
            return text[:-1].decode()
        except UnicodeDecodeError as error:
            raise CdrError(f'a string is not UTF-8: {error.reason}') from None


class Codec:
    """Encodes and decodes the messages of one type."""

    def __init__(self, type_name: str, text: str):
        """Parse a definition text with its dependencies; CdrError if it cannot be followed."""
        self.type_name = type_name
        self._types = _parse(type_name, text)
        self._root = _short(type_name)

    def encode(self, values: Mapping, padding: int = 0) -> bytes:
        """Return the CDR bytes; a field left out is zero, a misspelt one a CdrError."""
        sink = _Sink(padding)
        try:
            self._encode(sink, self._root, values)
        except (struct.error, TypeError, AttributeError, UnicodeEncodeError) as error:
            raise CdrError(f'{self.type_name}: {error}') from None
        return HEADER + bytes(sink.bytes)

    def decode(self, data: bytes) -> dict:
        """Return field name -> value; nested messages are dictionaries, arrays are lists."""
        return self._decode(_Source(data), self._root)

    def _encode(self, sink: _Sink, type_name: str, values: Mapping) -> None:
        fields = self._types[type_name]
        unknown = set(values) - {field.name for field in fields}
        if unknown:
            raise CdrError(f'{type_name} has no field {min(unknown)}')
        for field in fields:
            if field.length is None:
                self._encode_elements(sink, field, [values.get(field.name, _zero(field))])
                continue
            elements = values.get(field.name, [_zero(field)] * field.length)
            if field.length:
                if len(elements) != field.length:
                    raise CdrError(f'{type_name}.{field.name} takes {field.length} elements')
            else:
                sink.pack('I', [len(elements)])
            self._encode_elements(sink, field, elements)

    def _encode_elements(self, sink: _Sink, field: Field, elements) -> None:
        if field.format:
            sink.pack(field.format, elements)
        elif field.type_name == 'string':
            for text in elements:
                encoded = text.encode() + b'\0'
                sink.pack('I', [len(encoded)])
                sink.bytes += encoded
        else:
            for element in elements:
                self._encode(sink, field.type_name, element)

    def _decode(self, source: _Source, type_name: str) -> dict:
        values = {}
        for field in self._types[type_name]:
            if field.length is None:
                (values[field.name],) = self._decode_elements(source, field, 1)
            else:
                count = field.length or source.unpack('I', 1)[0]
                values[field.name] = self._decode_elements(source, field, count)
        return values

    def _decode_elements(self, source: _Source, field: Field, count: int) -> list:
        if field.format:
            return list(source.unpack(field.format, count))
        if field.type_name == 'string':
            return [source.string() for _ in range(count)]
        return [self._decode(source, field.type_name) for _ in range(count)]


@cache
def codec(type_name: str) -> Codec:
    """Return the codec of one of the package's own types."""
    return Codec(type_name, definition(type_name))


def _short(type_name: str) -> str:
    """Return `package/Name` for `package/msg/Name`."""
    package, *_, name = type_name.split('/')
    return f'{package}/{name}'


def _zero(field: Field):
    if field.format:
        return 0
    return '' if field.type_name == 'string' else {}


def _parse(type_name: str, text: str) -> dict[str, tuple[Field, ...]]:
    """Return short type name -> its fields, for the type and all it depends on."""
    own, *others = re.split(rf'^{SEPARATOR}\n', text, flags=re.MULTILINE)
    sections = {_short(type_name): own}
    for other in others:
        name, _, body = other.partition('\n')
        sections[_short(name.removeprefix('MSG:').strip())] = body
    types = {name: tuple(_fields(name, body)) for name, body in sections.items()}
    for fields in types.values():
        for field in fields:
            if not (field.format or field.type_name in (*types, 'string')):
                raise CdrError(f'{type_name}: no definition of {field.type_name}')
    return types


def _fields(type_name: str, body: str):
    """Yield the fields of one section; comments and constants are none."""
    for line in body.splitlines():
        match = _FIELD.match(line.partition('#')[0].strip())
        if not match or match['constant']:
            continue
        kind = match['type']
        if kind not in _PRIMITIVES and kind != 'string':
            kind = _short(kind) if '/' in kind else f'{type_name.split("/")[0]}/{kind}'
        length = None
        if match['array']:
            length = int(match['length']) if match['length'].isdigit() else 0
        yield Field(match['name'], kind, length)
