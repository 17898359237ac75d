# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator plot RECORDING FIGURE -o FILE`: one figure as PNG, SVG or PDF."""

from argparse import ArgumentParser, Namespace
from importlib.util import find_spec
import math
from pathlib import Path

from hydra_actuator.errors import InputError

SUMMARY = 'one figure of a recording as PNG, SVG or PDF'
PRESSURE_UNITS = ('Pa', 'bar', 'MPa')
LARGEST, FINEST = 100.0, 2400       # [inch], [1/inch]


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('recording', type=Path, metavar='RECORDING',
                        help='a recording directory, or one MCAP file')
    parser.add_argument('figure', metavar='FIGURE',
                        help='its name; an unknown one lists them')
    parser.add_argument('-o', '--output', type=Path, required=True, metavar='FILE',
                        help='the file to write: .png, .svg or .pdf; an earlier one is replaced')
    add_choice(parser)
    parser.add_argument('--at', type=float, nargs='+', default=[], metavar='T',
                        help='instants [s] of the figure streamline')
    parser.add_argument('--size', type=float, nargs=2, metavar=('W', 'H'),
                        help="width and height [inch]; default: the figure's own")
    parser.add_argument('--dpi', type=int, default=200, metavar='N',
                        help='dots per inch of what is made of dots (default 200)')


def add_choice(parser: ArgumentParser) -> None:
    """Declare what part of a run is shown, and in which units."""
    parser.add_argument('--from', dest='start', type=float, metavar='T',
                        help='start of the part shown [s from the first record]')
    parser.add_argument('--to', dest='end', type=float, metavar='T',
                        help='end of the part shown [s]; default: what the report shows first')
    add_units(parser)


def add_units(parser: ArgumentParser) -> None:
    """Declare in which units a run is shown."""
    parser.add_argument('--units', choices=PRESSURE_UNITS, default='MPa',
                        help='of pressures (default MPa)')
    parser.add_argument('--nondimensional', action='store_true',
                        help='u/V_max, x/L, p/p_max (gauge) and t c/L; options stay in seconds')


def check_choice(arguments: Namespace, verb: str) -> None:
    """Raise InputError for instants that are no numbers, or without matplotlib."""
    for name, values in (('from', [arguments.start]), ('to', [arguments.end]),
                         ('at', getattr(arguments, 'at', []))):
        for value in values:
            if value is not None and not math.isfinite(value):
                raise InputError(f'--{name} {value:g} is not a finite number')
    if find_spec('matplotlib') is None:
        raise InputError(f"{verb} needs matplotlib: pip install 'hydra_actuator[report]'")


def check_size(arguments: Namespace) -> None:
    """Raise InputError for a size [inch] or a resolution that no picture has."""
    for length in arguments.size or ():
        if not 1.0 <= length <= LARGEST:
            raise InputError(f'--size {length:g} is not within 1 to {LARGEST:g} inch')
    if not 10 <= arguments.dpi <= FINEST:
        raise InputError(f'--dpi {arguments.dpi} is not within 10 to {FINEST}')


def view(arguments: Namespace, instants=()):
    """Return the view that the command line asks for."""
    from hydra_actuator.analysis.extraction import series_of
    from hydra_actuator.analysis.plot import view_of

    series = series_of(arguments.recording)
    return view_of(series, arguments.start, arguments.end, instants, units_of(arguments, series))


def units_of(arguments: Namespace, series):
    """Return the units asked for, for a run; InputError where it cannot have them."""
    from hydra_actuator.analysis.units import nondimensional, units_named

    return nondimensional(series) if arguments.nondimensional else units_named(arguments.units)


def run(arguments: Namespace) -> int:
    """Write the figure and name it."""
    check_choice(arguments, 'plot')
    check_size(arguments)
    from hydra_actuator.analysis.picture_files import check_picture
    from hydra_actuator.analysis.plot import PLOTS, SUFFIXES, write_plot

    if arguments.figure not in PLOTS:
        raise InputError(f'no figure {arguments.figure!r}; there are {", ".join(PLOTS)}')
    if arguments.at and arguments.figure != 'streamline':
        raise InputError('--at goes with the figure streamline')
    check_picture(arguments.output, SUFFIXES)
    path = write_plot(arguments.figure, view(arguments, arguments.at), arguments.output,
                      arguments.size, arguments.dpi)
    print(f'{path}: {path.stat().st_size / 1e6:.2f} MB')
    return 0
