# SPDX-License-Identifier: Apache-2.0
"""Foxglove's own reader, @mcap/core, reads recordings whole, with all checksums checked."""

from collections import Counter
import json
from pathlib import Path
import shutil
import subprocess

from hydra_actuator.recording.recovery import recover
import pytest

PACKAGE = '@mcap/core@2.2.2'
SCRIPT = Path(__file__).with_name('read.mjs')


@pytest.fixture(scope='module')
def modules(request):
    """Return the folder @mcap/core is installed in, once for all runs of the tests."""
    for command in ('node', 'npm'):
        if shutil.which(command) is None:
            pytest.skip(f'no {command} here: @mcap/core cannot be run')
    folder = Path(request.config.cache.mkdir('mcap_core'))
    if not (folder / 'node_modules' / '@mcap' / 'core' / 'package.json').exists():
        installed = subprocess.run(
            ['npm', 'install', '--silent', '--no-fund', '--no-audit', '--prefix', folder, PACKAGE],
            capture_output=True, text=True, timeout=300, check=False)
        if installed.returncode:
            pytest.skip(f'npm cannot install {PACKAGE}: {installed.stderr[-200:]}')
    return folder


def read(modules, path) -> dict:
    """Return what the reader found."""
    found = subprocess.run(['node', SCRIPT, modules, path], capture_output=True, text=True,
                           timeout=120, check=False)
    assert found.returncode == 0, found.stderr
    return json.loads(found.stdout)


@pytest.mark.parametrize('origin', ['written', 'recovered'])
def test_every_message_is_read_as_it_was_written(make_recording, modules, tmp_path, origin):
    made = make_recording(chunk_size=3000)
    path = made.directory / 'run_0.mcap'
    if origin == 'recovered':
        recover(made.directory, tmp_path / 'again')
        path = tmp_path / 'again' / 'again_0.mcap'
    found = read(modules, path)
    written = made.messages()
    counts = Counter(topic for topic, *_ in written)
    assert found['profile'] == 'ros2'
    assert found['finished'] is True
    assert found['counts'] == found['streamed'] == counts
    assert found['schemas'] == {topic.name: topic.type for topic in made.topics.all()}
    for topic, payloads in found['payloads'].items():
        assert payloads == [[str(log_ns), str(publish_ns), data.hex()]
                            for name, log_ns, publish_ns, data in written if name == topic]


def test_a_flipped_bit_is_found_by_its_checksum(make_recording, modules):
    made = make_recording()
    path = made.directory / 'run_0.mcap'
    content = bytearray(path.read_bytes())
    content[content.index(made.messages()[100][3])] ^= 1
    path.write_bytes(content)
    found = subprocess.run(['node', SCRIPT, modules, path], capture_output=True, text=True,
                           timeout=120, check=False)
    assert found.returncode != 0
    assert 'crc' in found.stderr.lower()
