# SPDX-License-Identifier: Apache-2.0
"""The live view: what a snapshot looks like on a terminal."""

from datetime import datetime
import io

from hydra_actuator.ros.live_view import BLOCKS, instant, Snapshot, sparkline, Status, view
import pytest
from rich.console import Console


def printed(snapshot, width=90):
    console = Console(width=width, file=io.StringIO())
    console.print(view(snapshot))
    return console.file.getvalue()


def snapshot(**more):
    return Snapshot(
        '/left/actuator', stamp=12.5, position=-0.0125, velocity=0.25, effort=-1500.0,
        spools=(0.0005,), sections=(('A', 21.1e6, 1.5), ('J', -0.2e6, -6.25)), top=25e6,
        statuses={'Solver': Status(0, 'active', {'resets': '2'}),
                  'Real time': Status(1, '3 ticks missed in all')},
        history=(0.0, 0.01), events=((11.0, 2, 'the first'), (12.0, 0, 'the second')), **more)


def test_numbers_stand_there_with_their_units():
    text = printed(snapshot())
    for words in ('/left/actuator', 't = 12.500 s', '-12.500 mm', '+0.2500 m/s', '-1.500 kN',
                  '+0.5000 mm', '21.100 MPa', '-0.200 MPa', '-6.250 m/s', '0 to 25.0 MPa',
                  'seen +0.000 to +10.000 mm', '2 resets'):
        assert words in text


def test_the_worst_status_comes_first():
    text = printed(snapshot())
    assert text.index('3 ticks missed in all') < text.index('active')


def test_the_last_event_comes_first():
    text = printed(snapshot())
    assert text.index('t = 12.000 s  the second') < text.index('t = 11.000 s  the first')


def test_a_wide_terminal_has_the_diagnostics_beside_the_piston():
    def line_of(text, words):
        return next(k for k, line in enumerate(text.splitlines()) if words in line)
    wide, narrow = printed(snapshot(), 140), printed(snapshot(), 80)
    assert line_of(wide, 'position') == line_of(wide, 'ticks missed')
    assert line_of(narrow, 'position') < line_of(narrow, 'ticks missed')
    assert line_of(narrow, 'ticks missed') < line_of(narrow, 'pressure')


def test_before_anything_is_heard_it_says_what_it_waits_for_and_what_is_there():
    text = printed(Snapshot('/actuator', 'states on /joint_states', others=('/left/actuator',)))
    assert 'waiting for states on /joint_states' in text
    assert 'Nobody publishes there yet' in text
    assert 'Actuators here: /left/actuator' in text
    silent = printed(Snapshot('/actuator', 'states', present=True,
                              statuses={'Solver': Status(0, 'inactive')}))
    assert 'is it active?' in silent
    assert 'inactive' in silent


def test_silence_is_said_with_its_length_and_whether_the_node_is_gone():
    assert 'silent' not in printed(snapshot(age=0.2))
    assert 'silent for 3.0 s' in printed(snapshot(age=3.0, present=True))
    assert 'gone' not in printed(snapshot(age=3.0, present=True))
    assert 'silent for 3.0 s, and the node is gone' in printed(snapshot(age=3.0))


def test_two_spools_are_told_apart():
    text = printed(Snapshot('/actuator', stamp=0.0, position=0.0, spools=(1e-4, -2e-4)))
    assert '+0.1000 mm' in text
    assert 'spool 2' in text


def test_a_piston_at_rest_has_no_sign_and_a_flat_line():
    text = printed(Snapshot('/actuator', stamp=0.0, position=-1e-12, history=(-1e-12, 1e-12)))
    assert '-0.000' not in text
    assert BLOCKS[4] * 2 in text


def test_stamps_are_the_time_of_day_or_simulated_time():
    assert instant(1.5) == 't = 1.500 s'
    noon = datetime(2026, 5, 4, 12, 0, 0, 250000)
    assert instant(noon.timestamp()) == '12:00:00.250'


@pytest.mark.parametrize('values, line', [
    ((), ''), ((1.0, 1.0), BLOCKS[4] * 2), ((0.0, 1.0, 0.4), BLOCKS[1] + BLOCKS[8] + BLOCKS[4])])
def test_a_sparkline_reaches_from_lowest_to_highest(values, line):
    assert sparkline(values) == line
