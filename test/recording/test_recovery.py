# SPDX-License-Identifier: Apache-2.0
"""What comes out of a damaged recording was in it, and all that is sound comes out."""

from collections import Counter
from pathlib import Path
import random
import shutil
import signal
import threading

from hydra_actuator import load_recording
from hydra_actuator.recording import messages
from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.recovery import NothingSound, recover
from hydra_actuator.recording.topics import Topic
from hydra_actuator.recording.writer import RecordingWriter
from hypothesis import given, HealthCheck, Phase, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
import pytest
from rosbags.rosbag2 import Reader

TOPICS = [Topic('/spool', messages.FLOAT64, 'best_effort'), Topic('/load', messages.FLOAT64),
          Topic('/pressure', messages.FLUID_PRESSURE)]
TYPES = {topic.name: topic.type for topic in TOPICS}
CUSTOM_DATA = {'source': 'node', 'parameters': '/**: {}\n'}
COUNT = 60


def written():
    """Return the messages of the small recording in their order."""
    encode = messages.FluidPressureEncoder('A').encode
    found = []
    for k in range(COUNT // 3):
        stamp = 1000 + 10 * k
        found += [('/spool', stamp, stamp + 1, messages.float64(0.01 * k)),
                  ('/load', stamp + 2, stamp + 3, messages.float64(-5.0 * k)),
                  ('/pressure', stamp + 4, stamp + 5, encode(stamp + 4, 1e5 + k))]
    return found


class Small:
    """A small recording of several chunks: where they are, and which messages they hold."""

    def __init__(self, directory, compression):
        self.directory = directory
        with RecordingWriter(directory, TOPICS, CUSTOM_DATA, chunk_size=600,
                             compression=compression) as writer:
            writer.write_batch(written())
        (path,) = directory.glob('*.mcap')
        self.content = path.read_bytes()
        with path.open('rb') as file:
            summary = make_reader(file).get_summary()
            in_file = [(message.log_time, channel.topic)
                       for _, channel, message in make_reader(file).iter_messages()]
        assert len(in_file) == COUNT
        self.chunks = [(index.chunk_start_offset, index.chunk_start_offset + index.chunk_length)
                       for index in summary.chunk_indexes]
        spans = [(index.message_start_time, index.message_end_time)
                 for index in summary.chunk_indexes]
        self.messages = [[one for one in written() if start <= one[1] <= end]
                         for start, end in spans]
        self.summary = max(stop for _, stop in self.chunks)

    def damaged(self, tmp_path, content, with_metadata):
        """Return a recording of other bytes: a directory, or a lone file."""
        path = tmp_path / 'damaged'
        shutil.rmtree(path, ignore_errors=True)
        path.mkdir()
        (path / 'small_0.mcap').write_bytes(content)
        if not with_metadata:
            return path / 'small_0.mcap'
        shutil.copy(self.directory / 'metadata.yaml', path)
        return path


@pytest.fixture(scope='module', params=['none', 'zstd'])
def small(request, tmp_path_factory):
    return Small(tmp_path_factory.mktemp('small') / 'small', request.param)


def recovered(source, output):
    """Recover and return (what is said of it, the messages as another reader finds them)."""
    shutil.rmtree(output, ignore_errors=True)
    recovery = recover(source, output)
    found = []
    with open(output / f'{output.name}_0.mcap', 'rb') as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            found.append((channel.topic, message.log_time, message.publish_time, message.data))
            assert schema.name == TYPES[channel.topic]
    assert Counter(topic for topic, *_ in found) == +recovery.messages
    return recovery, found


def check_cut(small, tmp_path, size, with_metadata):
    """Cut a file and compare with the chunks that are wholly in what is left."""
    source = small.damaged(tmp_path, small.content[:size], with_metadata)
    whole = [one for (_, stop), batch in zip(small.chunks, small.messages) if stop <= size
             for one in batch]
    try:
        recovery, found = recovered(source, tmp_path / 'out')
    except NothingSound:
        assert not whole
        assert not (tmp_path / 'out').exists()
        return
    assert found == whole
    torn = any(start < size < stop for start, stop in small.chunks)
    if with_metadata:
        assert recovery.missing == Counter(t for t, *_ in written()) - Counter(
            t for t, *_ in whole)
        assert recovery.lossless == (len(whole) == COUNT)
    elif recovery.run_data_lost:
        assert not whole
    else:
        assert recovery.lossless == (not torn)


@pytest.mark.parametrize('with_metadata', [True, False])
def test_a_file_cut_anywhere_gives_its_whole_chunks(small, tmp_path, with_metadata):
    chosen = random.Random(3).sample(range(len(small.content)), 25)
    near = [stop + step for _, stop in small.chunks[:2] for step in (-1, 0, 1)]
    for size in [*chosen, *near]:
        check_cut(small, tmp_path, size, with_metadata)


@pytest.mark.soak
@pytest.mark.parametrize('with_metadata', [True, False])
def test_a_file_cut_at_every_byte_gives_its_whole_chunks(small, tmp_path, with_metadata):
    for size in range(len(small.content)):
        check_cut(small, tmp_path, size, with_metadata)


def check_flips(small, tmp_path, bits, with_metadata, size=None):
    """Flip bits: nothing new comes out, nothing is missing unsaid, sound chunks are all there."""
    content = bytearray(small.content[:size])
    for bit in bits:
        content[bit // 8] ^= 1 << bit % 8
    source = small.damaged(tmp_path, bytes(content), with_metadata)
    sound = [one for (start, stop), batch in zip(small.chunks, small.messages)
             if stop <= len(content) and not any(start <= bit // 8 < stop for bit in bits)
             for one in batch]
    in_opening = any(bit // 8 < small.chunks[0][0] for bit in bits)
    try:
        recovery, found = recovered(source, tmp_path / 'out')
    except NothingSound:
        # The definitions, and whatever else could have proved them.
        assert in_opening and (len(bits) > 1 or not (with_metadata or size is None))
        return
    complete = [one for (_, stop), batch in zip(small.chunks, small.messages)
                if stop <= len(content) for one in batch]
    # A bit of a chunk's head may be one that no message hangs on.
    assert found == [one for one in complete if one in found]
    if not in_opening or (len(bits) == 1 and size is None):
        assert set(sound) <= set(found)
    if found != complete:
        assert not recovery.lossless
    custom = load_recording(tmp_path / 'out').custom_data
    assert custom == CUSTOM_DATA or (recovery.run_data_lost and custom == {})


@pytest.mark.parametrize('with_metadata', [True, False])
def test_a_flipped_bit_costs_its_chunk_at_most(small, tmp_path, with_metadata):
    for bit in random.Random(5).sample(range(8 * len(small.content)), 30):
        check_flips(small, tmp_path, [bit], with_metadata)


@pytest.mark.soak
@pytest.mark.parametrize('with_metadata', [True, False])
@pytest.mark.parametrize('finished', [True, False])
def test_a_bit_flipped_in_any_byte_costs_its_chunk_at_most(small, tmp_path, with_metadata,
                                                          finished):
    size = None if finished else small.summary
    chosen = random.Random(11)
    for place in range(size or len(small.content)):
        check_flips(small, tmp_path, [8 * place + chosen.randrange(8)], with_metadata, size)


@settings(max_examples=25, deadline=None, derandomize=True,
          phases=[Phase.generate],
          suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), with_metadata=st.booleans(), finished=st.booleans())
def test_flipped_bits_of_any_number_bring_nothing_new(small, tmp_path, data, with_metadata,
                                                      finished):
    size = None if finished else small.summary
    last = 8 * (size or len(small.content)) - 1
    bits = data.draw(st.sets(st.integers(0, last), min_size=1, max_size=30))
    check_flips(small, tmp_path, sorted(bits), with_metadata, size)


def test_a_flipped_bit_in_a_topics_name_is_never_believed(small, tmp_path):
    place = small.content.index(b'/spool')
    content = bytearray(small.content[: small.summary])
    content[place + 1] ^= 1
    lone = small.damaged(tmp_path, bytes(content), with_metadata=False)
    with pytest.raises(NothingSound, match='proved'):
        recover(lone, tmp_path / 'out')
    whole = small.damaged(tmp_path, bytes(content), with_metadata=True)
    recovery, found = recovered(whole, tmp_path / 'out')
    assert found == written()
    assert not recovery.missing


def test_what_is_lost_is_told_by_topic_and_time(small, tmp_path):
    start, stop = small.chunks[1]
    content = bytearray(small.content)
    content[stop - 10] ^= 1
    recovery, _ = recovered(small.damaged(tmp_path, bytes(content), False), tmp_path / 'out')
    assert recovery.missing == Counter(topic for topic, *_ in small.messages[1])
    ((path, damage),) = recovery.damages
    assert path.name == 'small_0.mcap'
    assert (damage.start, damage.stop, damage.what) == (start, stop, 'damaged chunk')
    assert damage.before_ns == small.messages[0][-1][1]
    assert damage.after_ns == small.messages[2][0][1]


def test_what_comes_out_is_a_whole_rosbag2_directory(small, tmp_path):
    path = small.damaged(tmp_path, small.content[: small.summary], True)
    recovered(path, tmp_path / 'out')
    with Reader(tmp_path / 'out') as reader:
        assert {c.topic: c.msgtype for c in reader.connections} == TYPES
        assert len(list(reader.messages())) == COUNT
        quality = {c.topic: c.ext.offered_qos_profiles[0].reliability.name
                   for c in reader.connections}
    assert quality == {'/spool': 'BEST_EFFORT', '/load': 'RELIABLE', '/pressure': 'RELIABLE'}
    assert load_recording(tmp_path / 'out').custom_data == CUSTOM_DATA


def test_a_tail_of_zeros_is_a_damage(small, tmp_path):
    content = small.content[: small.summary] + bytes(5000)
    recovery, found = recovered(small.damaged(tmp_path, content, True), tmp_path / 'out')
    assert found == written()
    assert not recovery.missing
    assert [damage.what for _, damage in recovery.damages] == ['damaged end']


def test_several_files_become_one_and_a_missing_one_is_told(small, tmp_path):
    path = small.damaged(tmp_path, small.content, True)
    for number in (1, 2, 10):
        shutil.copy(path / 'small_0.mcap', path / f'small_{number}.mcap')
    text = (path / 'metadata.yaml').read_text()
    (path / 'metadata.yaml').write_text(
        text.replace('    - "small_0.mcap"\n', '    - "small_0.mcap"\n    - "small_3.mcap"\n'))
    recovery, found = recovered(path, tmp_path / 'out')
    assert Counter(found) == Counter(4 * written())
    assert recovery.lost_files == ['small_3.mcap']
    assert not recovery.lossless


@pytest.mark.parametrize('text', ['', 'a: [', 'rosbag2_bagfile_information: [1]\n',
                                  'rosbag2_bagfile_information: {custom_data: 3}\n'])
def test_damaged_metadata_does_no_harm(small, tmp_path, text):
    path = small.damaged(tmp_path, small.content, True)
    (path / 'metadata.yaml').write_text(text)
    recovery, found = recovered(path, tmp_path / 'out')
    assert found == written()
    assert recovery.lossless


def test_what_goes_in_is_not_touched_and_nothing_is_overwritten(small, tmp_path):
    path = small.damaged(tmp_path, small.content[:-300], True)
    before = {one.name: one.read_bytes() for one in path.iterdir()}
    (tmp_path / 'mine').mkdir()
    with pytest.raises(RecordingError, match='nothing is overwritten'):
        recover(path, tmp_path / 'mine')
    assert list((tmp_path / 'mine').iterdir()) == []
    recovered(path, tmp_path / 'out')
    assert {one.name: one.read_bytes() for one in path.iterdir()} == before


def test_what_holds_nothing_sound_leaves_nothing_behind(tmp_path):
    (tmp_path / 'text.mcap').write_text('this is not it')
    (tmp_path / 'in').mkdir()
    errors = {'text.mcap': NothingSound, 'nowhere': RecordingError, 'in': RecordingError}
    for name, error in errors.items():
        with pytest.raises(error):
            recover(tmp_path / name, tmp_path / 'deep' / 'out')
        assert not (tmp_path / 'deep').exists()


def test_ctrl_c_leaves_nothing_half_made(small, tmp_path):
    def interrupt(share: float) -> None:
        signal.raise_signal(signal.SIGINT)

    assert threading.current_thread() is threading.main_thread()
    with pytest.raises(KeyboardInterrupt):
        recover(small.directory, tmp_path / 'deep' / 'out', interrupt)
    assert list(Path(tmp_path).iterdir()) == []
