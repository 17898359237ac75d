# SPDX-License-Identifier: Apache-2.0
"""One value against the definition of its parameter."""

import math

from hydra_actuator.parameters import ParameterError, PARAMETERS
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

STROKE = PARAMETERS['valve.stroke']
CELLS = PARAMETERS['solver.cells']


def test_integer_is_taken_for_a_double():
    value = PARAMETERS['cylinder.mass'].check(12)
    assert value == 12.0
    assert type(value) is float


def test_numpy_scalars_become_plain_values():
    assert type(PARAMETERS['cylinder.mass'].check(np.float32(1.5))) is float
    assert type(CELLS.check(np.int64(100))) is int
    assert type(PARAMETERS['autostart'].check(np.True_)) is bool
    assert PARAMETERS['sections.positions'].check(np.array([1, 2])) == (1.0, 2.0)


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 10**400])
def test_number_that_is_not_finite_is_refused(value):
    with pytest.raises(ParameterError, match=r'valve\.stroke = .*: not a finite number'):
        STROKE.check(value)


@pytest.mark.parametrize('name, value', [
    ('valve.stroke', '0.001'), ('valve.stroke', True), ('valve.stroke', None),
    ('valve.stroke', [0.001]), ('solver.cells', 200.0), ('solver.cells', False),
    ('autostart', 1), ('autostart', 'true'), ('timing.mode', 3), ('sections.names', 'A'),
    ('sections.names', [1]), ('sections.positions', 1.0), ('timing.cpu_affinity', [0.5]),
    ('recording.directory', 'two\nlines'),
])
def test_value_of_the_wrong_type_is_refused_by_name(name, value):
    with pytest.raises(ParameterError) as caught:
        PARAMETERS[name].check(value)
    assert str(caught.value).startswith(f'{name} = ')
    assert '\n' not in str(caught.value)


def test_limit_that_is_broken_is_named_with_its_unit():
    with pytest.raises(ParameterError, match=r'^valve\.stroke = 2\.0: above the maximum 0\.5 m$'):
        STROKE.check(2)


def test_choice_that_is_not_offered_is_answered_with_the_choices():
    with pytest.raises(ParameterError, match='none, constant, steady, unsteady'):
        PARAMETERS['line_1.friction'].check('turbulent')


def test_limits_hold_for_every_element_of_a_list():
    with pytest.raises(ParameterError, match='below the minimum 0'):
        PARAMETERS['timing.cpu_affinity'].check([0, -1])


def test_refused_value_of_any_size_makes_a_short_line():
    with pytest.raises(ParameterError) as caught:
        STROKE.check('x' * 10000)
    assert len(str(caught.value)) < 150


@given(st.floats(allow_nan=True) | st.integers())
def test_number_is_accepted_exactly_within_its_limits(value):
    limits = STROKE.minimum <= value <= STROKE.maximum
    if limits:
        assert STROKE.check(value) == float(value)
    else:
        with pytest.raises(ParameterError):
            STROKE.check(value)


@pytest.mark.parametrize('one', PARAMETERS.values(), ids=PARAMETERS.keys())
def test_default_passes_its_own_check_unchanged(one):
    assert one.check(one.default) == one.default
    assert type(one.check(one.default)) is type(one.default)


@pytest.mark.parametrize('one', PARAMETERS.values(), ids=PARAMETERS.keys())
def test_every_parameter_says_what_it_means(one):
    assert one.meaning and '\n' not in one.meaning
    assert one.type != 'double' or (one.unit and one.minimum < one.maximum)
    assert not one.choices or one.default in one.choices
