# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator animate RECORDING -o FILE`: the actuator in motion, as GIF, MP4 or HTML."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from hydra_actuator.cli.plot import add_choice, check_choice, check_size, view
from hydra_actuator.cli.progress import ProgressBar
from hydra_actuator.errors import InputError

SUMMARY = 'the actuator in motion, oil coloured by pressure, as GIF, MP4 or HTML'
MOST_FRAMES, FASTEST = 5000, 100.0


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('recording', type=Path, metavar='RECORDING',
                        help='a recording directory, or one MCAP file')
    parser.add_argument('-o', '--output', type=Path, required=True, metavar='FILE',
                        help='the file to write: .gif, .mp4 or .html; an earlier one is replaced')
    add_choice(parser)
    parser.add_argument('--frames', type=int, default=120, metavar='N',
                        help='how many instants, evenly over the part shown (default 120)')
    parser.add_argument('--fps', type=float, default=20.0, metavar='HZ',
                        help='frames per second of the picture (default 20)')
    parser.add_argument('--size', type=float, nargs=2, default=(9.0, 5.6), metavar=('W', 'H'),
                        help='width and height [inch] (default 9 5.6)')
    parser.add_argument('--dpi', type=int, default=100, metavar='N',
                        help='dots per inch (default 100)')


def run(arguments: Namespace) -> int:
    """Write the moving picture and name it."""
    check_choice(arguments, 'animate')
    check_size(arguments)
    if not 2 <= arguments.frames <= MOST_FRAMES:
        raise InputError(f'--frames {arguments.frames} is not within 2 to {MOST_FRAMES}')
    if not 0.1 <= arguments.fps <= FASTEST:
        raise InputError(f'--fps {arguments.fps:g} is not within 0.1 to {FASTEST:g}')
    from hydra_actuator.analysis.animation import write_animation
    from hydra_actuator.analysis.movie_files import movie_writer, MOVIES
    from hydra_actuator.analysis.picture_files import check_picture

    path = check_picture(arguments.output, MOVIES)
    movie_writer(path.suffix, arguments.fps)
    with ProgressBar('animate') as progress:
        write_animation(view(arguments), path, arguments.frames, arguments.fps, arguments.size,
                        arguments.dpi, progress)
    print(f'{path}: {path.stat().st_size / 1e6:.2f} MB')
    return 0
