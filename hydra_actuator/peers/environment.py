# SPDX-License-Identifier: Apache-2.0
"""Each peer in an environment of its own, made when first asked for, at versions of our choice."""

import os
from pathlib import Path
import subprocess
import sys
from typing import NamedTuple

STAMP = 'installed.txt'
PATIENCE = 900.0        # [s] for an installation
# Of what a sourced ROS or this environment sets, nothing is theirs.
FOREIGN = ('PYTHONPATH', 'PYTHONHOME', 'LD_LIBRARY_PATH', '_ROS_WHEELS_BOOTSTRAP_COMPLETE')
OLD = ('numpy==1.26.4', 'scipy==1.13.1', 'pandas==2.1.4', 'setuptools==80.9.0',
       'six==1.17.0')


class Peer(NamedTuple):
    """Another solver: its name, the script that runs it, what pip installs, steps to time."""

    name: str
    script: str
    packages: tuple[str, ...]
    steps: int


PEERS = (
    Peer('RTHYM-MOC', 'rthym_line.py', ('rthym-moc==0.4.1', 'numpy==2.2.6'), 20000),
    Peer('TSNet', 'tsnet_line.py', ('tsnet==0.3.1', 'wntr==1.2.0', *OLD), 1000),
    Peer('PTSNET', 'ptsnet_line.py', (
        'ptsnet==0.1.10', 'mpi4py==4.1.2', 'mpich==5.0.2', 'h5py==3.16.0', 'tqdm==4.70.1',
        'numba==0.68.1', 'wntr==1.2.0', *OLD), 1000),
)


class NotInstalled(Exception):
    """A peer could not be installed or does not run here; the text says why, in a line."""


def python_of(peer: Peer, folder: Path) -> Path:
    """Return the Python that has a peer, installing it if need be; NotInstalled if it cannot."""
    place = folder / peer.script.partition('_')[0]
    python, stamp = place / 'bin' / 'python', place / STAMP
    wanted = '\n'.join(peer.packages)
    if stamp.exists() and stamp.read_text() == wanted:
        return python
    _run([sys.executable, '-m', 'venv', '--clear', str(place)])
    _run([str(python), '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check',
          *peer.packages])
    stamp.write_text(wanted)
    return python


def clean_environment() -> dict[str, str]:
    """Return the environment of a peer's process: nothing of ours, one thread."""
    kept = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    return {**kept, 'OMP_NUM_THREADS': '1', 'OPENBLAS_NUM_THREADS': '1', 'MKL_NUM_THREADS': '1'}


def _run(command: list[str]) -> None:
    try:
        done = subprocess.run(command, env=clean_environment(), capture_output=True, text=True,
                              timeout=PATIENCE)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NotInstalled(f'{type(error).__name__}: {error}'[:200]) from error
    if done.returncode:
        raise NotInstalled(last_line(done.stderr))


def last_line(text: str) -> str:
    """Return the last line that says what is wrong."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [line for line in lines if 'error' in line.lower()]
    return (errors or lines or ['no reason given'])[-1][:200]
