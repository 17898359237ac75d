# SPDX-License-Identifier: Apache-2.0
"""A file is seen block by block, and what was given back is read again."""

from hydra_actuator import load_recording
from hydra_actuator.recording.block import Block, join, JOINED, KEPT, MappedFile
import numpy as np
import pytest


@pytest.fixture
def file(tmp_path):
    """Return a mapped file of 64 KiB of random bytes, and the bytes."""
    content = np.random.default_rng(1).integers(0, 256, 1 << 16, np.uint8)
    (tmp_path / 'file').write_bytes(content.tobytes())
    return MappedFile(tmp_path / 'file'), content


def test_what_was_forgotten_is_read_again(file):
    mapped, content = file
    seen = mapped.bytes[5000:60_000]
    mapped.forget(4000, 61_000)
    np.testing.assert_array_equal(seen, content[5000:60_000])


def test_an_empty_file_has_no_bytes(tmp_path):
    (tmp_path / 'empty').touch()
    mapped = MappedFile(tmp_path / 'empty')
    mapped.forget(0, 10)
    assert len(mapped.bytes) == 0


def test_blocks_that_follow_each_other_are_one_with_offsets_into_it(file):
    mapped, content = file
    blocks = [Block(mapped, start, start + 900) for start in range(0, 10_000, 1000)]
    for k, block in enumerate(blocks):
        block.offsets = {3: np.array([10, 20])} | ({4: np.array([k])} if k % 2 else {})
    (joined,) = join(blocks)
    expected = [1000 * k + offset for k in range(10) for offset in (10, 20)]
    assert joined.offsets[3].tolist() == expected
    assert joined.offsets[4].tolist() == [1001 * k for k in range(1, 10, 2)]
    with joined.opened() as seen:
        np.testing.assert_array_equal(seen[joined.offsets[3]], content[expected])


def test_blocks_are_joined_to_a_fair_size_only(tmp_path):
    size = JOINED // 4
    (tmp_path / 'file').write_bytes(bytes(10 * size))
    mapped = MappedFile(tmp_path / 'file')
    sizes = [block.size for block in join(
        [Block(mapped, k * size, (k + 1) * size) for k in range(10)])]
    assert sum(sizes) == 10 * size
    assert max(sizes) == JOINED


def test_what_is_packed_is_unpacked_once_for_topics_that_are_read_together(file):
    mapped, content = file
    opened = []

    def unpack(packed):
        opened.append(1)
        return packed[::-1]
    blocks = [Block(mapped, 100 * k, 100 * k + 100, 100, unpack) for k in range(3 * KEPT)]
    assert join(blocks) == blocks
    for k, block in enumerate(blocks):
        for _ in range(5):
            with block.opened() as seen:
                np.testing.assert_array_equal(seen[::-1], content[100 * k: 100 * k + 100])
    assert len(opened) == len(blocks)
    assert len(mapped.unpacked) == KEPT


def test_states_at_one_stamp_share_its_first_pressures(make_recording):
    made = make_recording(ticks=10)
    content = (made.directory / 'run_0.mcap').read_bytes()
    (made.directory / 'run_1.mcap').write_bytes(content)
    recording = load_recording(made.directory)
    pressures = recording.rows[:, recording.channels.pressure]
    np.testing.assert_array_equal(pressures, np.tile(made.rows[:, made.channels.pressure], (2, 1)))


def test_columns_are_those_of_the_rows(make_recording):
    recording = load_recording(make_recording().directory)
    channels = recording.channels
    wanted = [channels.flow_velocity.start, channels.TIME, channels.LOAD_FORCE,
              channels.pressure.stop - 1]
    np.testing.assert_array_equal(recording.columns(wanted), recording.rows[:, wanted])
