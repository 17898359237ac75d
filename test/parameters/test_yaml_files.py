# SPDX-License-Identifier: Apache-2.0
"""Parameter files: keys, values and complaints, without ROS."""

from hydra_actuator.parameters import ParameterError, read_parameter_file
from hydra_actuator.parameters.yaml_files import as_parameter_file, read_scalar
from hypothesis import given
from hypothesis import strategies as st
import pytest


@pytest.fixture
def read(tmp_path):
    def read(text, node=None):
        path = tmp_path / 'given.yaml'
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_parameter_file(path, node)
    return read


@pytest.mark.parametrize('text, value', [
    ('1.4534e9', 1.4534e9), ('1e-05', 1e-5), ('010', 8), ('0x1F', 31), ('12:30', '12:30'),
    ('~', '~'), ('2001-01-01', '2001-01-01'), ('1_000', '1_000'), ('off', False), ('y', True),
    ('099', 99.0), ('5.', 5.0), ('.5', 0.5), ('+5', 5), ('0b1', '0b1'), ('.inf', float('inf')),
])
def test_scalar_is_read_as_rcl_reads_it(text, value):
    assert read_scalar(text) == value
    assert type(read_scalar(text)) is type(value)


def test_quoted_scalar_is_a_string():
    assert read_scalar('1.5', quoted=True) == '1.5'


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_read_back_with_the_same_bits(number):
    line = as_parameter_file({'x': number}).splitlines()[-1]
    assert read_scalar(line.partition(': ')[2]).hex() == number.hex()


def test_dots_and_nesting_mean_the_same(read):
    nested = read('/**: {ros__parameters: {valve: {stroke: 1.0, overlap_pa: 2.0}}}')
    assert nested == read('/**: {ros__parameters: {valve.stroke: 1.0, valve: {overlap_pa: 2.0}}}')
    assert nested == {'valve.stroke': 1.0, 'valve.overlap_pa': 2.0}


@pytest.mark.parametrize('key', [
    '/**', '"*"', '/left/actuator', 'left/actuator', '/*/actuator', '/**/actuator',
])
def test_key_for_any_or_this_node_counts(read, key):
    text = f'{key}: {{ros__parameters: {{a: 1}}}}'
    node = '/actuator' if key == '"*"' else '/left/actuator'
    assert read(text, node) == {'a': 1}
    assert read(text) == {'a': 1}


@pytest.mark.parametrize('key', ['/right/actuator', 'actuator', '/*', '/left/actuator_2'])
def test_key_for_another_node_does_not_count(read, key):
    assert read(f'{key}: {{ros__parameters: {{a: 1}}}}', '/left/actuator') == {}


def test_namespaces_may_be_nested(read):
    text = '\n'.join(
        f'{side}: {{actuator: {{ros__parameters: {{a: {value}}}}}}}'
        for side, value in (('left', 1), ('right', 2))
    )
    assert read(text, '/right/actuator') == {'a': 2}


def test_of_several_keys_the_later_wins(read):
    text = '/**: {ros__parameters: {a: 1, b: 1}}\nactuator: {ros__parameters: {a: 2}}'
    assert read(text) == {'a': 2, 'b': 1}


def test_keys_of_other_nodes_in_a_shared_file_are_left_alone(read):
    text = 'controller: {ros__parameters: {gain: 1}}\nactuator: {ros__parameters: {a: 2}}'
    assert read(text) == {'a': 2}


@pytest.mark.parametrize('text, complaint', [
    ('', 'holds no ros__parameters'),
    ('a: 1', 'line 1'),
    ('/**: {a: 1}', "'a' stands under no ros__parameters"),
    ('ros__parameters: {a: 1}', 'no node name'),
    ('/**: {ros__parameters: }', 'holds no parameters'),
    ('/**:\n  ros__parameters:\n    valve:\n', 'line 3: valve has no value'),
    ('/**:\n  ros__parameters:\n    a: 1\n    a: 2\n', "line 4: 'a' stands there twice"),
    ('/**: {ros__parameters: {a: &x 1, b: *x}}', 'aliases'),
    ('/**: {ros__parameters: {a: [1, 2.5]}}', 'mixes float and int'),
    ('/**: {ros__parameters: {a: [[1]]}}', 'a list within a list'),
    ('/**:\n\tros__parameters:', 'not YAML: line 2'),
    ('/**: {ros__parameters: {a: 1}', 'not YAML'),
    (b'\xff\xfe\x00', 'cannot be read'),
    ('x: {ros__parameters: {a: 1}}\ny: {ros__parameters: {a: 1}}', 'only for x, y'),
    ('a: 1\x07', 'not YAML'),
])
def test_file_that_cannot_be_used_is_named_in_one_line(read, tmp_path, text, complaint):
    with pytest.raises(ParameterError) as caught:
        read(text)
    message = str(caught.value)
    assert message.startswith(f'{tmp_path}/given.yaml: ')
    assert complaint in message
    assert '\n' not in message


def test_missing_file_and_folder_are_named(tmp_path):
    with pytest.raises(ParameterError, match=r'missing\.yaml: cannot be read'):
        read_parameter_file(tmp_path / 'missing.yaml')
    with pytest.raises(ParameterError, match='cannot be read'):
        read_parameter_file(tmp_path)
