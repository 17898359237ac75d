# SPDX-License-Identifier: Apache-2.0
"""Command messages are taken whole or dropped whole, and every one is counted."""

import math

from hydra_actuator.ros.commands import CommandDesk, CommandRules, RejectedCommandError
from hypothesis import given
from hypothesis import strategies as st
import pytest

STROKE = 5e-4


def desk(spools=1, scale=1.0):
    return CommandDesk(CommandRules(spools, STROKE, scale, 'valve'))


def test_one_value_moves_both_spools():
    assert desk(2).spool_command(0.25) == (0.25, 0.25)


def test_array_moves_each_spool():
    assert desk(2).commands([0.25, -0.5]) == (0.25, -0.5)


def test_scale_is_the_size_of_a_full_command():
    assert desk(scale=10.0).spool_command(5.0) == (0.5, 0.5)
    assert desk(2, scale=10.0).commands([-10.0, 1.0]) == (-1.0, 0.1)


def test_joint_command_is_a_displacement_whatever_the_scale():
    assert desk(scale=10.0).joint_commands(['valve'], [STROKE / 4]) == (0.25, 0.25)


def test_out_of_range_is_clamped_and_counted():
    own = desk(2)
    assert own.commands([1.5, -0.5]) == (1.0, -0.5)
    assert own.commands([0.0, -7.0]) == (0.0, -1.0)
    assert own.commands([1.0, -1.0]) == (1.0, -1.0)
    assert (own.accepted, own.clamped, own.rejections) == (3, 2, 0)


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_dropped_and_counted(value):
    own = desk(2)
    for judge in (
        lambda: own.spool_command(value),
        lambda: own.commands([0.5, value]),
        lambda: own.load_force(value),
    ):
        with pytest.raises(RejectedCommandError, match='not finite'):
            judge()
    assert (own.accepted, own.rejected['not finite']) == (0, 3)


def test_a_stamp_too_far_from_now_is_dropped_and_counted():
    own = desk()
    own.rules = CommandRules(1, STROKE, 1.0, 'valve', max_age=0.5)
    for age in (0.0, 0.5, -0.5):
        assert own.joint_commands(['valve'], [STROKE / 4], age) == (0.25, 0.25)
    for age, reason in ((0.501, 'stale stamp'), (-0.501, 'stamp in the future'),
                        (2.0**31, 'stale stamp')):
        with pytest.raises(RejectedCommandError, match=rf'{reason}: [0-9.]+ s, at most 0.5 s'):
            own.joint_commands(['valve'], [STROKE / 4], age)
    assert (own.accepted, own.rejections) == (3, 3)


def test_stamps_are_not_judged_unless_asked_for():
    assert desk().joint_commands(['valve'], [STROKE / 4], 1e9) == (0.25, 0.25)


@pytest.mark.parametrize('values', [[], [0.1], [0.1, 0.2, 0.3]])
def test_array_of_a_wrong_length_is_dropped(values):
    own = desk(2)
    with pytest.raises(RejectedCommandError, match=f'{len(values)} values for 2 spools'):
        own.commands(values)
    assert own.rejected['wrong length'] == 1


def test_joint_command_finds_its_joints_by_name():
    own = desk(2)
    found = own.joint_commands(
        ['piston', 'valve_2', 'other', 'valve'], [9.0, -STROKE, math.nan, STROKE / 2])
    assert found == (0.5, -1.0)


def test_joint_command_may_have_positions_of_the_first_joints_only():
    assert desk().joint_commands(['valve', 'piston'], [STROKE]) == (1.0, 1.0)


def test_joint_command_of_other_joints_says_nothing():
    own = desk()
    assert own.joint_commands(['piston'], [1.0]) is None
    assert own.joint_commands([], []) is None
    assert (own.accepted, own.rejections, own.without_command) == (0, 0, 2)


@pytest.mark.parametrize('positions', [[math.nan, 0.0], [0.0, math.nan], [math.nan, math.nan]])
def test_nan_in_a_joint_command_means_no_command_yet(positions):
    own = desk(2)
    assert own.joint_commands(['valve', 'valve_2'], positions) is None
    assert (own.accepted, own.rejections, own.without_command) == (0, 0, 1)


@pytest.mark.parametrize('names, positions, reason', [
    (['valve', 'valve'], [0.0, 0.0], "duplicate joint name: 'valve'"),
    (['valve', 'valve_2', 'x', 'x'], [0.0] * 4, "duplicate joint name: 'x'"),
    (['valve', 'valve_2'], [0.0], 'index beyond the array'),
    (['valve', 'valve_2'], [], 'index beyond the array'),
    (['valve'], [0.0], 'wrong length'),
    (['valve', 'valve_2'], [0.0, math.inf], 'not finite'),
    (['valve', 'valve_2'], [math.nan, math.inf], 'not finite'),
])
def test_unusable_joint_command_is_dropped_whole(names, positions, reason):
    own = desk(2)
    with pytest.raises(RejectedCommandError, match=reason):
        own.joint_commands(names, positions)
    assert (own.accepted, own.rejections) == (0, 1)
    assert own.last_rejection.startswith(reason)


def test_of_endless_names_a_rejection_keeps_the_beginning():
    own = desk()
    names = [f'{number:06}' for number in range(50_000)] + ['n' * 10_000] * 2
    with pytest.raises(RejectedCommandError):
        own.joint_commands(names, [0.0] * len(names))
    assert own.last_rejection.startswith("duplicate joint name: 'nnn")
    assert len(own.last_rejection) < 200


@given(st.lists(st.floats(), max_size=4), st.sampled_from([1, 2]))
def test_whatever_comes_is_in_range_or_dropped_and_counted_once(values, spools):
    own = desk(spools)
    try:
        taken = own.commands(values)
    except RejectedCommandError:
        assert (own.accepted, own.rejections) == (0, 1)
    else:
        assert all(-1.0 <= spool <= 1.0 for spool in taken)
        assert taken == (min(1.0, max(-1.0, values[0])), min(1.0, max(-1.0, values[-1])))
        assert (own.accepted, own.rejections) == (1, 0)


def test_rules_come_from_the_parameters():
    from hydra_actuator import load_parameters

    rules = CommandRules.of(load_parameters(overrides={
        'valve.spools': 2, 'valve.stroke': 1e-3, 'command.scale': 10, 'command.valve_joint': 'v',
        'command.max_age': 0.5}))
    assert rules == CommandRules(2, 1e-3, 10.0, 'v', 0.5)
    assert rules.valve_joints == ('v', 'v_2')
