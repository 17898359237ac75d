# SPDX-License-Identifier: Apache-2.0
"""What is varied: read from text, checked against the parameters' own definitions."""

from hydra_actuator.errors import InputError
from hydra_actuator.parameters import Parameters
from hydra_actuator.sweep.factor import read_factor, refuse_overlap
import numpy as np
import pytest

BASE = Parameters()
SHARES = np.linspace(0.0, 1.0, 1001)[:-1]


@pytest.mark.parametrize('text', [
    'cylinder.area_1+cylinder.area_2=0.0005:0.002:log', 'valve.stroke=0.0001:0.001',
    'solver.cells=50,100', 'solver.cells=50:100', 'line_1.friction=none,constant',
    'fluid.cavitation=true,false'])
def test_a_factor_reads_back_from_its_text(text):
    factor = read_factor(text, BASE)
    assert read_factor(factor.as_text(), BASE) == factor


def test_tied_parameters_have_one_name_and_one_value():
    factor = read_factor('line_1.length+line_2.length=0.1:0.5', BASE)
    assert factor.name == 'line_1.length'
    assert factor.names == ('line_1.length', 'line_2.length')


def test_values_stay_within_their_range_and_reach_its_ends():
    for text in ('valve.stroke=0.0001:0.001', 'valve.stroke=0.0001:0.001:log'):
        values = read_factor(text, BASE).values(SHARES)
        assert min(values) == pytest.approx(1e-4)
        assert 1e-4 <= min(values) < max(values) <= 1e-3
        assert max(values) > 0.99e-3


def test_a_logarithmic_range_has_its_middle_at_the_geometric_mean():
    assert read_factor('cylinder.mass=1:100:log', BASE).values(np.array([0.5])) == \
        pytest.approx([10.0])


def test_whole_numbers_have_equal_shares_ends_included():
    values = read_factor('solver.iterations=1:4', BASE).values(SHARES)
    assert {type(value) for value in values} == {int}
    # A share that falls on an edge goes to either side.
    assert [values.count(k) for k in (1, 2, 3, 4)] == pytest.approx([250] * 4, abs=1)


def test_levels_have_equal_shares():
    values = read_factor('line_1.friction=none,constant', BASE).values(SHARES)
    assert values.count('none') == values.count('constant') == 500


def test_a_grid_goes_from_end_to_end():
    assert read_factor('cylinder.mass=1:100:log', BASE).grid(3) == pytest.approx([1, 10, 100])
    assert read_factor('solver.iterations=1:3', BASE).grid(7) == [1, 2, 3]


@pytest.mark.parametrize(('text', 'message'), [
    ('valve.stroke', 'is not NAME=LOW:HIGH'), ('=1:2', 'is not NAME=LOW:HIGH'),
    ('valve.strok=1e-4:1e-3', "did you mean 'valve.stroke'"),
    ('valve.stroke=1e-4:2', 'valve.stroke = 2.0: above the maximum 0.5 m'),
    ('valve.stroke=nan:1e-3', 'not a finite number'),
    ('valve.stroke=a:b', 'a number is wanted, not a string'),
    ('valve.stroke=1e-3:1e-4', '0.001 is not below 0.0001'),
    ('valve.stroke=1e-4:5e-4:1e-3', 'is not NAME=LOW:HIGH'),
    ('cylinder.leakage=0:1e-12:log', 'begins above 0'),
    ('line_1.friction=none:constant', 'line_1.friction is no number'),
    ('line_1.friction=none,rough', "line_1.friction = 'rough': not one of"),
    ('solver.cells=50.5:60', 'an integer is wanted'),
    ('sections.names=A,B', 'sections.names is a list'),
    ('valve.stroke+valve.stroke=1e-4:1e-3', 'names a parameter twice'),
    ('valve.stroke=1e-4,1e-4', 'holds a value twice'),
    ('cylinder.mass+valve.stroke=0.1:5', 'valve.stroke = 5.0: above the maximum')])
def test_what_is_no_factor_is_refused_in_one_line(text, message):
    with pytest.raises(InputError, match=r'^[^\n]+$') as refused:
        read_factor(text, BASE)
    assert message in str(refused.value)


def test_a_parameter_is_varied_once():
    one = read_factor('valve.stroke=1e-4:1e-3', BASE)
    with pytest.raises(InputError, match='is varied twice'):
        refuse_overlap((one, one))
    with pytest.raises(InputError, match='nothing is varied'):
        refuse_overlap(())
