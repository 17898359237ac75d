# SPDX-License-Identifier: Apache-2.0
"""Any text survives metadata.yaml, and what it says of an empty recording."""

from hydra_actuator.recording.errors import RecordingError
from hydra_actuator.recording.metadata import BagMetadata, FileInformation, quoted, read_metadata
from hydra_actuator.recording.topics import ActuatorTopics
from hypothesis import example, given
from hypothesis import strategies as st
import pytest
import yaml


@given(st.text())
@example('a: 1\r\n\t"b" \\ \x7f\x85\u2028\ufeff\ud800 🛢 # {}')
def test_any_text_survives_quoting(text):
    assert '\n' not in quoted(text)
    if not any('\ud800' <= sign <= '\udfff' for sign in text):
        assert yaml.safe_load(quoted(text)) == text


def test_an_empty_recording_says_so():
    topics = ActuatorTopics('/actuator', ('O',)).all()
    counts = {topic.name: 0 for topic in topics}
    text = BagMetadata(topics, {}).text([FileInformation('a_0.mcap', None, None, 0)], counts)
    information = yaml.safe_load(text)['rosbag2_bagfile_information']
    assert information['message_count'] == 0
    assert information['duration'] == {'nanoseconds': 0}
    assert information['starting_time'] == {'nanoseconds_since_epoch': 2**63 - 1}
    assert information['custom_data'] is None


def test_several_files_make_one_span():
    topics = ActuatorTopics().all()
    files = [FileInformation('a_0.mcap', 100, 300, 2), FileInformation('a_1.mcap', 301, 900, 3)]
    text = BagMetadata(topics, {}).text(files, {topic.name: 0 for topic in topics})
    information = yaml.safe_load(text)['rosbag2_bagfile_information']
    assert information['message_count'] == 5
    assert information['duration'] == {'nanoseconds': 800}
    assert information['relative_file_paths'] == ['a_0.mcap', 'a_1.mcap']
    assert [file['message_count'] for file in information['files']] == [2, 3]


@pytest.mark.parametrize('content', [b'', b'a: [', b'other: 1\n', b'\xff\xfe\x00'])
def test_what_is_not_metadata_is_refused_by_name(content, tmp_path):
    (tmp_path / 'metadata.yaml').write_bytes(content)
    with pytest.raises(RecordingError, match=r'metadata\.yaml'):
        read_metadata(tmp_path)
