# SPDX-License-Identifier: Apache-2.0
"""A fault script is taken whole, or refused with file, line and culprit."""

from hydra_actuator.errors import InputError
from hydra_actuator.faults import read_script
from hydra_actuator.parameters import definitions
import pytest

TABLE = definitions(('A', 'tap_2'))
HEADER = 'time,parameter,value\n'


def test_rows_have_times_parameters_and_values_of_their_types(tmp_path):
    script = tmp_path / 'script.csv'
    script.write_text(HEADER + '0,fault.leakage,2e-12\n\n'
                      ' 1.5 , fault.pressure.tap_2.stuck , True\n1.5,fault.leakage,0\n')
    assert read_script(script, TABLE) == (
        (0.0, 'fault.leakage', 2e-12), (1.5, 'fault.pressure.tap_2.stuck', True),
        (1.5, 'fault.leakage', 0.0))


def test_no_path_is_no_script():
    assert read_script('', TABLE) == ()


@pytest.mark.parametrize('text, complaint', [
    ('', 'is empty; it needs the header time,parameter,value'),
    ('time,fault\n', "header 'time,fault' is not time,parameter,value"),
    (HEADER, 'has no rows'),
    (HEADER + '1,fault.leakage\n', 'line 2: 2 values for 3 columns'),
    (HEADER + '1,fault.leakage,0,0\n', 'line 2: 4 values for 3 columns'),
    (HEADER + 'soon,fault.leakage,0\n', "line 2: time 'soon' is not a number"),
    (HEADER + 'nan,fault.leakage,0\n', "line 2: time 'nan' is not finite"),
    (HEADER + '-1,fault.leakage,0\n', 'line 2: time -1 s is before 0'),
    (HEADER + '2,fault.leakage,0\n\n1,fault.leakage,0\n', 'line 4: time 1 s falls after 2 s'),
    (HEADER + '1,fault.leakege,0\n', "line 2: unknown parameter 'fault.leakege'; did you mean "
     "'fault.leakage'?"),
    (HEADER + '1,fault.pressure.B.off,1\n', "line 2: unknown parameter 'fault.pressure.B.off': "
     "sections.names has no 'B', but A, tap_2"),
    (HEADER + '1,fault.enabled,true\n', 'line 2: fault.enabled is no fault'),
    (HEADER + '1,fault.script,other.csv\n', 'line 2: fault.script is no fault'),
    (HEADER + '1,supply.pressure,1e6\n', 'line 2: supply.pressure is no fault'),
    (HEADER + '1,fault.leakage,much\n', "line 2: fault.leakage 'much' is not a number"),
    (HEADER + '1,fault.leakage,1\n', 'line 2: fault.leakage = 1.0: above the maximum 1e-06 m^3'),
    (HEADER + '1,fault.valve_stuck,perhaps\n', "line 2: fault.valve_stuck 'perhaps' is not true"),
    (HEADER + '1,fault.valve_stuck,1.5\n', "line 2: fault.valve_stuck '1.5' is not true or"),
    ('\udcff', 'it is no CSV text'),
])
def test_rubbish_is_refused_in_one_line_with_its_place(tmp_path, text, complaint):
    script = tmp_path / 'script.csv'
    script.write_bytes(text.encode('utf-8', 'surrogateescape'))
    with pytest.raises(InputError) as refusal:
        read_script(script, TABLE)
    message = str(refusal.value)
    assert message.startswith(str(script))
    assert complaint in message
    assert '\n' not in message


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError, match=r'nowhere\.csv cannot be read: No such file'):
        read_script(tmp_path / 'nowhere.csv', TABLE)
