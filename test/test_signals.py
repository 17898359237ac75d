# SPDX-License-Identifier: Apache-2.0
"""Command signals over time, and the CSV file: what it means and what is refused in it."""

import os

from hydra_actuator.errors import InputError
from hydra_actuator.signals import Chirp, Hold, read_table, Sine, Step, Table
import numpy as np
import pytest

TIMES = np.array([0.0, 0.25, 0.5, 1.0, 2.0])


def written(tmp_path, text):
    """Return a CSV file of this text (or these bytes)."""
    path = tmp_path / 'command.csv'
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def refusal(path):
    """Return the message a file is refused with; it names the file and is one line."""
    with pytest.raises(InputError) as refused:
        read_table(path)
    message = str(refused.value)
    assert str(path) in message
    assert '\n' not in message
    return message


@pytest.mark.parametrize('signal', [
    Hold(0.3, 500.0), Sine(1.0), Step(), Chirp(1.0, 5.0, 2.0),
    Table(TIMES, TIMES / 2.0, TIMES), Table(TIMES, TIMES / 2.0, TIMES, hold=True),
])
def test_a_signal_gives_two_equal_spools_and_a_load_at_each_time(signal):
    command = signal(TIMES)
    assert command.shape == (5, 3)
    assert np.array_equal(command[:, 0], command[:, 1])
    assert np.isfinite(command).all()


def test_hold_is_constant():
    assert np.array_equal(Hold(0.3, -500.0)(TIMES), np.tile([0.3, 0.3, -500.0], (5, 1)))


def test_sine_has_its_frequency_and_amplitude():
    assert Sine(1.0, 0.5)(TIMES)[:, 0] == pytest.approx([0.0, 0.5, 0.0, 0.0, 0.0], abs=1e-15)


def test_step_begins_at_its_start():
    assert Step(-0.5, 0.5)(TIMES)[:, 0].tolist() == [0.0, 0.0, -0.5, -0.5, -0.5]
    assert Step()(TIMES)[:, 0].tolist() == [1.0] * 5


def test_chirp_sweeps_from_its_first_to_its_last_frequency():
    # 18 whole turns in 3 s: both ends are at phase 0, where the slope is 2 pi times the frequency.
    chirp, near = Chirp(2.0, 10.0, 3.0), np.array([0.0, 1e-6])
    for start, frequency in ((0.0, 2.0), (3.0 - 1e-6, 10.0)):
        slope = np.diff(chirp(start + near)[:, 0]) / 1e-6
        assert slope == pytest.approx(2.0 * np.pi * frequency, rel=1e-4)


def test_table_is_linear_between_its_rows_and_constant_beyond(tmp_path):
    table = read_table(written(tmp_path, 'time,spool,load_force\n1,0,0\n2,0.5,-100\n4,-0.5,100\n'))
    command = table(np.array([0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0]))
    assert command[:, 0].tolist() == [0.0, 0.0, 0.25, 0.5, 0.0, -0.5, -0.5]
    assert command[:, 2].tolist() == [0.0, 0.0, -50.0, -100.0, 0.0, 100.0, 100.0]
    assert table.duration == 4.0


def test_table_on_hold_keeps_each_row_until_the_next_has_come(tmp_path):
    table = read_table(written(tmp_path, 'time,spool\n1,0.1\n2,0.5\n4,-0.5\n'), hold=True)
    command = table(np.array([0.0, 1.0, 1.999, 2.0, 3.999, 4.0, 9.0]))
    assert command[:, 0].tolist() == [0.1, 0.1, 0.1, 0.5, 0.5, -0.5, -0.5]
    assert not command[:, 2].any()


def test_interpolation_never_passes_full_spool():
    generator = np.random.default_rng(1)
    times = np.cumsum(generator.random(1000))
    table = Table(times, np.where(np.arange(1000) % 2, 1.0, -1.0), np.zeros(1000))
    assert np.abs(table(np.sort(np.nextafter(times, 0.0)))).max() <= 1.0


@pytest.mark.parametrize('text', [
    'time,spool\n0,0\n1,1\n', 'time,spool\r\n0,0\r\n1,1\r\n', '\ufefftime,spool\n0,0\n1,1\n',
    ' time , spool \n 0 , 0 \n\n1e0,+1.0\n   \n', 'time,spool,load_force\n0,0,0\n1,1,-0\n',
    '"time","spool"\n"0","0"\n"1","1"',
])
def test_spreadsheets_of_all_kinds_are_read_alike(tmp_path, text):
    table = read_table(written(tmp_path, text))
    assert table.times.tolist() == [0.0, 1.0]
    assert table.spool.tolist() == [0.0, 1.0]
    assert table.load_force.tolist() == [0.0, 0.0]


@pytest.mark.parametrize('text, culprit', [
    ('', 'is empty'), ('\n', "header ''"), ('time,spool\n', 'no rows'),
    ('time,spool\n\n \n', 'no rows'),
    ('time,spol\n0,0\n', "header 'time,spol'"), ('spool,time\n0,0\n', "header 'spool,time'"),
    ('0,0\n1,1\n', "header '0,0'"), ('time;spool\n0;0\n', "header 'time;spool'"),
    ('time,spool,load\n0,0,0\n', "header 'time,spool,load'"),
    ('time,spool\n0,0\n0.1\n', 'line 3: 1 values for 2 columns'),
    ('time,spool\n0,0,0\n', 'line 2: 3 values for 2 columns'),
    ('time,spool\n0,0\n\n0.1,open\n', "line 4: spool 'open' is not a number"),
    ('time,spool\n0,\n', "line 2: spool '' is not a number"),
    ('time,spool\n0,0\n1_0,0\n', "line 3: time '1_0' is not a number"),
    ('time,spool\n0,nan\n', "line 2: spool 'nan' is not finite"),
    ('time,spool\ninf,0\n', "line 2: time 'inf' is not finite"),
    ('time,spool,load_force\n0,0,NaN\n', "line 2: load_force 'NaN' is not finite"),
    ('time,spool\n0,1.01\n', 'line 2: spool 1.01 is not within -1 to 1'),
    ('time,spool\n0,-2\n', 'line 2: spool -2 is not within -1 to 1'),
    ('time,spool\n-1,0\n', 'line 2: time -1 s is before 0'),
    ('time,spool\n0,0\n\n1,0\n1,1\n', 'line 5: time 1 s does not increase after 1 s'),
    ('time,spool\n0,0\n2,0\n1,1\n', 'line 4: time 1 s does not increase after 2 s'),
    (b'\x89PNG\r\n\x1a\n\x00\x00\xff', 'no CSV text'), (b'time,spool\n0,\x00\n', ''),
    ('time,"' + 'x' * 200_000, 'no CSV text'), ('y' * 100_000, "yyy...' is neither"),
])
def test_a_file_that_is_no_command_is_refused_with_its_line(tmp_path, text, culprit):
    message = refusal(written(tmp_path, text))
    assert culprit in message
    assert len(message) < 300


def test_a_file_that_cannot_be_opened_is_refused_with_the_reason(tmp_path):
    assert 'No such file' in refusal(tmp_path / 'nowhere.csv')
    assert 'directory' in refusal(tmp_path)
    assert 'Not a directory' in refusal(written(tmp_path, 'x') / 'command.csv')
    os.symlink('loop.csv', tmp_path / 'loop.csv')
    assert 'loop.csv cannot be read' in refusal(tmp_path / 'loop.csv')
