# SPDX-License-Identifier: Apache-2.0
"""Walls and pistons that move through the mesh."""

from hydra_actuator.verification import cell_crossing, free_stream, mirror, moving_wall
from hydra_actuator.verification.case import failures


def test_driven_wall_sends_the_exact_nonlinear_wave():
    assert not failures(moving_wall.driven_piston())


def test_exact_wave_leaves_the_wall_with_its_speed_and_reaches_no_further_than_sound():
    time = 0.01
    assert moving_wall.exact_velocity(moving_wall.wall_place(time), time) == (
        moving_wall.wall_speed(time))
    assert moving_wall.exact_velocity(moving_wall.WAVE_SPEED * time + 1e-9, time) == 0.0


def test_uniform_stream_passes_a_moving_mesh_undisturbed():
    assert not failures(free_stream.free_stream())


def test_face_that_crosses_cells_adds_no_line_to_the_spectrum():
    assert not failures(cell_crossing.cell_crossing())


def test_first_order_interpolation_adds_lines_where_they_are_looked_for():
    found = cell_crossing.lines('linear')
    for place in ('v/dx - tone', 'v/dx + tone'):
        height, excess = found[place]
        assert height > 1e-6
        assert excess > 100.0


def test_negative_command_gives_the_mirror_image():
    assert not failures(mirror.mirror())
