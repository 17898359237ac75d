# SPDX-License-Identifier: Apache-2.0
"""The nodes of a field stand where the piston lets them."""

from dataclasses import replace

from hydra_actuator.analysis import streamline
from hydra_actuator.analysis.decimation import bucket_extremes
import numpy as np


def piston_at_frames(run):
    return np.interp(run.field.time, run.time, run.position)


def test_every_frame_is_a_gapless_row_in_streamline_order(run):
    x = streamline.node_positions(run.field, piston_at_frames(run))
    assert np.all(np.diff(x, axis=1) >= 0)
    assert np.all(np.isfinite(streamline.gapless(run.field, run.field.pressure)))


def test_the_faces_of_the_piston_move_with_it(run):
    piston = piston_at_frames(run)
    x = streamline.node_positions(run.field, piston)
    for face in run.field.faces:
        np.testing.assert_array_equal(x[:, face], 1.0 + piston)


def test_an_even_grid_sees_each_chamber_up_to_the_piston(run):
    piston = piston_at_frames(run)
    x = streamline.node_positions(run.field, piston)
    grid = np.linspace(0.801, 1.199, 200)
    pressure = streamline.on_even_grid(x, streamline.gapless(run.field, run.field.pressure), grid)
    frame = int(np.argmax(np.abs(run.field.pressure[:, run.field.faces[0]] - 11e6)))
    first = run.field.pressure[frame, run.field.faces[0]]
    second = run.field.pressure[frame, run.field.faces[1]]
    expected = np.where(grid < 1.0 + piston[frame], first, second)
    np.testing.assert_allclose(pressure[frame], expected)


def test_extremes_on_a_grid_are_those_of_either_chamber_within_the_stroke(run):
    _, _, highest = bucket_extremes(run.field.pressure, 1)
    grid = np.array([0.3, 0.9, 1.0, 1.1, 1.7])
    row = streamline.extremes_on_even_grid(run.field, highest, grid, highest=True)[0]
    np.testing.assert_allclose(row, [21e6, 16e6, 16e6, 16e6, 2.5e6], rtol=1e-3)


def test_twelve_stations_are_a_field_with_a_moving_piston(run):
    field = streamline.field_of_stations(run)
    assert field.faces == (5, 6)
    assert field.labels == tuple(d for d in streamline.DOMAINS for _ in range(2))
    np.testing.assert_array_equal(field.pressure, run.pressure)


def test_stations_in_any_order_give_the_same_field(run):
    backwards = replace(
        run, section_names=run.section_names[::-1], pressure=run.pressure[:, ::-1],
        section_positions=run.section_positions[::-1], flow_velocity=run.flow_velocity[:, ::-1],
    )
    np.testing.assert_array_equal(
        streamline.field_of_stations(backwards).pressure, run.pressure,
    )


def test_few_stations_are_no_field(run):
    few = replace(run, section_names=('A', 'B'), section_positions=np.array([0.6, 0.6]),
                  pressure=run.pressure[:, 1:3], flow_velocity=run.flow_velocity[:, 1:3])
    assert streamline.field_of_stations(few) is None


def test_boundaries_carry_the_letters_of_their_stations(run):
    expected = [(0, 'O'), (0.6, 'A|B'), (0.8, 'C|D'), (1.2, 'G|H'), (1.4, 'I|J'), (2.0, 'K')]
    for field in (run.field, streamline.field_of_stations(run)):
        found = streamline.boundaries(field)
        assert [letters for _, letters in found] == [letters for _, letters in expected]
        np.testing.assert_allclose([x for x, _ in found], [x for x, _ in expected])
