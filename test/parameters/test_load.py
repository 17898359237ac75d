# SPDX-License-Identifier: Apache-2.0
"""Whole sets of parameters: nothing wrong gets in, nothing right gets lost."""

import pickle

from hydra_actuator import load_parameters
from hydra_actuator.parameters import definitions, ParameterError, PARAMETERS, Parameters
from hypothesis import assume, given
from hypothesis import strategies as st
import pytest

STATIONS = PARAMETERS['sections.names'].default


def file_with(folder, body, name='given.yaml'):
    path = folder / name
    path.write_text(body)
    return path


@st.composite
def single_changes(draw):
    """Return one {name: value} that its own definition accepts; a fault with its switch."""
    one = draw(st.sampled_from([one for one in PARAMETERS.values() if not one.is_array]))
    switch = {'fault.enabled': True} if one.name.startswith('fault.') else {}
    if one.choices:
        return {one.name: draw(st.sampled_from(one.choices))}
    return {**switch, one.name: draw({
        'double': st.floats(one.minimum, one.maximum) if one.type == 'double' else None,
        'integer': st.integers(one.minimum, one.maximum) if one.type == 'integer' else None,
        'bool': st.booleans(),
        'string': st.text(st.characters(codec='utf-8'), max_size=20).filter(str.isprintable),
    }[one.type])}


def accepted(changes):
    try:
        return Parameters(changes)
    except ParameterError:
        return None


def test_no_file_is_needed():
    parameters = load_parameters()
    assert parameters['supply.pressure'] == 21e6
    assert parameters['sections.names'] == tuple('OABCDEFGHIJK')
    assert parameters.changed() == {}


@given(single_changes())
def test_accepted_change_survives_writing_and_reading(tmp_path_factory, changes):
    parameters = accepted(changes)
    assume(parameters is not None)
    path = file_with(tmp_path_factory.mktemp('yaml'), parameters.as_yaml())
    assert load_parameters(path) == parameters


@given(single_changes(), single_changes())
def test_replacing_in_turn_equals_giving_both(first, second):
    assume(first.keys() != second.keys())
    both, alone = accepted({**first, **second}), accepted(first)
    assume(both is not None and alone is not None)
    assert alone.replace(second) == both
    assert hash(alone.replace(second)) == hash(both)


@given(single_changes())
def test_changed_is_what_makes_the_difference(changes):
    parameters = accepted(changes)
    assume(parameters is not None)
    assert Parameters(parameters.changed()) == parameters
    assert parameters.changed().keys() <= changes.keys()


@given(st.text(max_size=30))
def test_any_other_name_is_unknown(name):
    assume(name not in PARAMETERS and not name.startswith(('qos_overrides.', 'fault.pressure')))
    assume(name not in ('use_sim_time', 'start_type_description_service'))
    with pytest.raises(ParameterError, match='unknown parameter'):
        load_parameters(overrides={name: 1.0})


@pytest.mark.parametrize('misspelt, meant', [
    ('valve.strok', 'valve.stroke'), ('fluid.bulk_modulos', 'fluid.bulk_modulus'),
    ('supply.presure', 'supply.pressure'), ('timing.perod', 'timing.period'),
    ('bulk_modulus', 'fluid.bulk_modulus'), ])
def test_misspelt_name_is_answered_with_the_one_that_was_meant(misspelt, meant):
    with pytest.raises(ParameterError, match=f'did you mean .*{meant}'):
        load_parameters(overrides={misspelt: 1})


def test_a_fault_of_a_section_that_is_not_there_is_answered_with_those_that_are():
    with pytest.raises(ParameterError, match=r"'fault\.pressure\.Z\.stuck'.* no 'Z', but O, A"):
        load_parameters(overrides={'fault.pressure.Z.stuck': True})


@pytest.mark.parametrize('name', [
    'use_sim_time', 'start_type_description_service', 'qos_overrides./clock.subscription.depth',
])
def test_parameters_of_ros_itself_are_never_unknown(name):
    assert load_parameters(overrides={name: True}) == load_parameters()


def test_later_file_wins_and_overrides_win_over_files(tmp_path):
    one = file_with(tmp_path, '/**: {ros__parameters: {cylinder.mass: 1, tank.pressure: 5}}')
    two = file_with(tmp_path, '/**: {ros__parameters: {cylinder.mass: 2}}', 'later.yaml')
    assert load_parameters(one, two)['cylinder.mass'] == 2.0
    assert load_parameters(one, two)['tank.pressure'] == 5.0
    assert load_parameters(one, two, overrides={'cylinder.mass': 3})['cylinder.mass'] == 3.0


def test_file_to_blame_is_named(tmp_path):
    good = file_with(tmp_path, '/**: {ros__parameters: {cylinder.mass: 1}}', 'good.yaml')
    bad = file_with(tmp_path, '/**: {ros__parameters: {valve.stroke: -1}}', 'bad.yaml')
    with pytest.raises(ParameterError, match=rf'^{bad}: valve\.stroke = -1\.0: below the minimum'):
        load_parameters(bad, good)


def test_section_names_decide_which_pressure_faults_there_are():
    named = {'sections.names': ['rod_end'], 'sections.positions': [1.2]}
    parameters = load_parameters(overrides={
        **named, 'fault.enabled': True, 'fault.pressure.rod_end.offset': 5})
    assert parameters['fault.pressure.rod_end.offset'] == 5.0
    assert 'fault.pressure.A.offset' not in parameters
    assert set(parameters) == set(definitions(('rod_end',)))


def test_replacing_the_sections_drops_the_faults_of_lost_ones():
    before = load_parameters(overrides={
        'fault.enabled': True, 'fault.pressure.A.offset': 5.0})
    assert 'fault.pressure.A.offset' not in before.replace({'sections.names': ['B']})
    assert before.replace({'sections.names': ['A']})['fault.pressure.A.offset'] == 5.0


def test_refused_replacement_leaves_the_parameters_as_they_were():
    parameters = load_parameters()
    text = parameters.as_yaml()
    with pytest.raises(ParameterError):
        parameters.replace({'supply.pressure': 1e7, 'valve.stroke': -1.0})
    assert parameters.as_yaml() == text


def test_parameters_cannot_be_changed_in_place():
    with pytest.raises(TypeError):
        load_parameters()['valve.stroke'] = 1.0


def test_parameters_travel_between_processes():
    parameters = load_parameters(overrides={'cylinder.mass': 3.0})
    assert pickle.loads(pickle.dumps(parameters)) == parameters


def test_looking_up_a_misspelt_name_says_what_was_meant():
    with pytest.raises(KeyError, match=r'valve\.stroke'):
        load_parameters()['valve.strok']
