# SPDX-License-Identifier: Apache-2.0
"""`hydra_actuator export RECORDING -o OUT`: a recording as CSV, Parquet or NetCDF."""

from argparse import ArgumentParser, Namespace
from importlib.util import find_spec
import math
from pathlib import Path

from hydra_actuator.errors import InputError

SUMMARY = 'a recording as CSV, Parquet or NetCDF, with units'
NEEDED = ('xarray', 'pandas', 'pyarrow', 'netCDF4')


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the command line."""
    parser.add_argument('recording', help='a recording directory, or one MCAP file')
    parser.add_argument('-o', '--output', type=Path, required=True, metavar='OUT',
                        help='the file to write: .csv, .parquet or .nc')
    parser.add_argument('--format', choices=('csv', 'parquet', 'netcdf'),
                        help='default: by the suffix of the file')
    parser.add_argument('--topics', nargs='+', default=[], metavar='TOPIC',
                        help='of joint_states, applied, pressure, sections, cavities, field; '
                             'default: all, the field only into NetCDF')
    parser.add_argument('--rate', type=float, metavar='HZ',
                        help='keep the first state after each instant; default: every state')


def run(arguments: Namespace) -> int:
    """Write the file and name it."""
    if arguments.rate is not None and not 0.0 < arguments.rate < math.inf:
        raise InputError(f'--rate {arguments.rate:g} is not a positive number')
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise InputError(f'export needs {", ".join(missing)}: '
                         "pip install 'hydra_actuator[export]'")
    from hydra_actuator.recording.export import export, format_of
    from hydra_actuator.recording.reader import load_recording

    format_of(arguments.output, arguments.format)
    written = export(load_recording(arguments.recording), arguments.output, arguments.format,
                     arguments.topics, arguments.rate)
    for path in written:
        print(f'{path}: {path.stat().st_size / 1e6:.2f} MB')
    return 0
