# SPDX-License-Identifier: Apache-2.0
"""Moving pictures: what moves is where the run says, and a file is whole or not there."""

from dataclasses import replace
import os
import re
import signal
import subprocess
import sys
import time

from hydra_actuator.analysis.animation import Animation, write_animation
from hydra_actuator.analysis.plot import view_of
from hydra_actuator.errors import InputError
from matplotlib.animation import AbstractMovieWriter
import numpy as np
import pytest

SMALL = {'frames': 5, 'rate': 10.0, 'size': (3.0, 2.0), 'dots_per_inch': 40}
# A quarter and three quarters of a period of 20 ms.
HIGH, LOW = 0.305, 0.315
PATIENCE = 120.0


def test_the_piston_stands_where_the_run_says(run):
    animation = Animation(view_of(run, HIGH, LOW), frames=2)
    places = []
    for k in range(2):
        animation.show(k)
        places.append(animation._scene._piston.get_x() + animation._scene._unit)
    assert places == pytest.approx([1.012, 0.988], abs=1e-6)


def test_the_spool_slides_up_for_a_to_b_and_down_for_a_to_i(run):
    animation = Animation(view_of(run, HIGH, LOW), frames=2)
    shown = []
    for k in range(2):
        animation.show(k)
        scene = animation._scene
        shown.append((scene._path.get_text(), scene._lands[0].get_y()))
    (direct, up), (reverse, down) = shown
    assert (direct, reverse) == ('A to B', 'A to I')
    assert up > down


def test_the_oil_has_the_colour_of_its_pressure(run):
    animation = Animation(view_of(run, HIGH, LOW), frames=2)
    animation.show(0)
    scene = animation._scene
    supply = scene._oil[0][0].get_array()[0, 0]
    assert np.allclose(supply, scene._colours.to_rgba(21.0))
    line = dict(zip(*animation._line.get_data()))
    assert line[0.0] == pytest.approx(21.0)
    assert line[2.0] == pytest.approx(2.5)


def test_a_gif_holds_all_frames(run, tmp_path):
    from PIL import Image
    path = write_animation(view_of(run), tmp_path / 'run.gif', **SMALL)
    with Image.open(path) as picture:
        assert picture.n_frames == 5
        assert picture.size == (120, 80)
        assert picture.info['duration'] == 100


def test_an_mp4_can_be_decoded(run, tmp_path):
    from imageio_ffmpeg import count_frames_and_secs
    path = write_animation(view_of(run), tmp_path / 'run.mp4', **SMALL)
    frames, seconds = count_frames_and_secs(str(path))
    assert frames == 5
    assert seconds == pytest.approx(0.5, abs=0.11)


def test_a_page_holds_everything_and_fetches_nothing(run, tmp_path):
    text = write_animation(view_of(run), tmp_path / 'run.html', **SMALL).read_text()
    assert len(re.findall('iVBORw0KGgo', text)) == 5
    assert not re.search(r'https?://|src="(?!data:)', text)
    assert "default-src 'none'" in text
    assert '@' not in text


def test_progress_reaches_the_end(run, tmp_path):
    shares = []
    write_animation(view_of(run), tmp_path / 'run.html', progress=shares.append, **SMALL)
    assert shares == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])


@pytest.mark.parametrize('suffix', ['gif', 'mp4', 'html'])
def test_an_interruption_leaves_the_earlier_file(run, tmp_path, suffix):
    path = tmp_path / f'run.{suffix}'
    path.write_bytes(b'earlier')

    def interrupt(share):
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        write_animation(view_of(run), path, progress=interrupt, **SMALL)
    assert [one.name for one in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b'earlier'


def test_without_the_streamline_there_is_nothing_to_move(run):
    few = replace(run, field=None, section_names=('A', 'E'), section_positions=np.array([0.6, 1]),
                  pressure=run.pressure[:, :2], flow_velocity=run.flow_velocity[:, :2])
    with pytest.raises(InputError, match='neither the field nor'):
        Animation(view_of(few))


def test_a_page_is_written_by_a_writer_of_matplotlib():
    from hydra_actuator.analysis.movie_files import movie_writer
    assert isinstance(movie_writer('.html', 10.0), AbstractMovieWriter)


def test_ctrl_c_in_a_terminal_leaves_no_file(make_run, record, tmp_path):
    recording = record(make_run(0.2))
    directory = tmp_path / 'out'
    directory.mkdir()
    # A terminal sends Ctrl-C to the encoder as well: the whole group gets it.
    process = subprocess.Popen(
        [sys.executable, '-m', 'hydra_actuator', 'animate', str(recording), '-o',
         str(directory / 'run.mp4'), '--frames', '5000', '--size', '3', '2', '--dpi', '40'],
        stderr=subprocess.PIPE, text=True, start_new_session=True)
    deadline = time.monotonic() + PATIENCE
    while not any(directory.iterdir()) and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, message = process.communicate(timeout=PATIENCE)
    assert (process.returncode, message) == (130, '')
    assert not list(directory.iterdir())
