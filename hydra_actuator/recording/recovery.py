# SPDX-License-Identifier: Apache-2.0
"""
A new recording made of what is sound in an unfinished or damaged one.

Every message that comes out was proved, with its topic, by a checksum or by two copies that agree:
none is made up. What goes in is only read. How much is missing is known from the sequence numbers
of what is left, from sound summaries and from metadata.yaml; a message of a topic of which nothing
else is known can be missing unnoticed only within a damage, and each damage is told.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from hydra_actuator.errors import Failure
from hydra_actuator.interruption import Interruption
from hydra_actuator.recording.chunks import chunk_messages, chunk_records, mapped
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.metadata import mcap_files, read_metadata
from hydra_actuator.recording.proof import Proof, prove
from hydra_actuator.recording.salvage import Damage, Salvage, salvage
from hydra_actuator.recording.segment import Message
from hydra_actuator.recording.writer import RecordingWriter
import numpy as np


class NothingSound(Failure):
    """A recording holds nothing that could be proved."""


@dataclass
class Recovery:
    """What came of it; counts by topic, times [ns] as recorded."""

    output: Path
    messages: Counter[str] = field(default_factory=Counter)
    missing: Counter[str] = field(default_factory=Counter)
    unproved: int = 0
    damages: list[tuple[Path, Damage]] = field(default_factory=list)
    lost_files: list[str] = field(default_factory=list)
    run_data_lost: bool = False
    start_ns: int | None = None
    end_ns: int | None = None

    @property
    def lossless(self) -> bool:
        """Tell whether nothing that the files held is missing."""
        return not (self.missing or self.unproved or self.damages or self.lost_files
                    or self.run_data_lost)


@dataclass(frozen=True)
class _Source:
    """One file: what is sound in it and what that proves."""

    found: Salvage
    proof: Proof
    content: np.ndarray


def recover(
    recording: str | Path, output: str | Path,
    progress: Callable[[float], None] = lambda share: None,
) -> Recovery:
    """
    Write what is sound of a recording directory, or of a lone MCAP file, to a new recording.

    Raises RecordingError if there is no such recording or the output exists, and NothingSound,
    in which cases, as on Ctrl-C, nothing is left behind.
    """
    path = Path(recording)
    metadata, paths, lost = _files(path)
    with Interruption() as interruption:
        interruption.hold()
        sources = []
        for one in paths:
            content = mapped(one)
            found = salvage(one)
            interruption.raise_if_asked()
            sources.append(_Source(found, prove(found, content, metadata), content))
        topics = list(dict.fromkeys(
            topic for source in sources for topic in source.proof.topics.values()))
        if not topics:
            raise NothingSound(f'{path}: nothing in it can be proved to be of a recording')
        custom_data = next((source.proof.custom_data for source in sources
                            if source.proof.custom_data is not None), None)
        recovery = Recovery(Path(output), lost_files=lost, run_data_lost=custom_data is None)
        writer = RecordingWriter(output, topics, custom_data,
                                 compression=sources[0].found.compression or 'none')
        try:
            for share, batch in _batches(sources):
                interruption.raise_if_asked()
                writer.write_batch(_counted(batch, recovery))
                progress(share)
            writer.close()
        except BaseException:
            writer.discard()
            raise
    _account(recovery, sources, metadata)
    return recovery


def _files(path: Path) -> tuple[Mapping, list[Path], list[str]]:
    """Return metadata.yaml as far as it is readable, the files, and those that are not there."""
    if path.is_file():
        return {}, [path], []
    if not path.is_dir():
        raise RecordingError(f'{path} does not exist')
    try:
        metadata = read_metadata(path)
    except RecordingError:
        metadata = {}
    metadata = metadata if isinstance(metadata, dict) else {}
    present = mcap_files(path)
    listed = metadata.get('relative_file_paths')
    listed = [str(name) for name in listed] if isinstance(listed, list) else []
    if not present:
        raise RecordingError(f'{path} is not a recording: it holds no MCAP files')
    lost = [name for name in listed if not (path / name).is_file()]
    return metadata, present, lost


def _batches(sources: list[_Source]) -> Iterator[tuple[float, list[Message]]]:
    """Yield the share done and the proved messages of each sound chunk."""
    total = sum(len(source.found.chunks) for source in sources)
    done = 0
    for source in sources:
        names = {number: topic.name for number, topic in source.proof.topics.items()}
        for chunk in source.found.chunks:
            content = chunk_records(source.content, chunk.start, chunk.stop)
            if content is None:
                raise Failure(f'{source.found.path} changes while it is read')
            done += 1
            yield done / total, [
                (names[channel], log_ns, publish_ns, data.tobytes())
                for channel, _, log_ns, publish_ns, data in chunk_messages(content)
                if channel in names
            ]


def _counted(batch: list[Message], recovery: Recovery) -> list[Message]:
    recovery.messages.update(topic for topic, *_ in batch)
    if batch:
        times = [log_ns for _, log_ns, *_ in batch]
        first = min(times) if recovery.start_ns is None else min(recovery.start_ns, *times)
        recovery.start_ns, recovery.end_ns = first, max(recovery.end_ns or 0, *times)
    return batch


def _account(recovery: Recovery, sources: list[_Source], metadata: Mapping) -> None:
    """Find out what is missing, by topic, and which damages may hide more."""
    expected: Counter[str] = Counter()
    for source in sources:
        found, proof = source.found, source.proof
        counted = found.counted if found.counted is not None else {}
        for number in found.messages.keys() | counted.keys():
            known = max(counted.get(number, 0), found.messages.get(number, 0),
                        found.sequences.get(number, 0) if proof.own else 0)
            if number in proof.topics:
                expected[proof.topics[number].name] += known
            else:
                recovery.unproved += known
        complete = found.counted is not None and found.counted == {
            number: found.messages.get(number, 0) for number in found.counted}
        if not complete:
            recovery.damages += [(found.path, damage) for damage in found.damages]
    for entry in metadata.get('topics_with_message_count') or ():
        try:
            name, count = entry['topic_metadata']['name'], int(entry['message_count'])
        except (KeyError, TypeError, ValueError):
            continue
        expected[name] = max(expected[name], count)
    recovery.missing = +Counter({
        name: count - recovery.messages[name] for name, count in expected.items()
    })
