# SPDX-License-Identifier: Apache-2.0
"""
Ours and the peers in turn, round by round, so that a busy machine is the same for all.

Computing time, not time on the clock; the ratio to a peer is the median over the rounds. Ours
stands there with two passes, as by default, and with one.
"""

from collections.abc import Callable
import json
from pathlib import Path
import statistics
import subprocess
import tempfile
from typing import NamedTuple

from hydra_actuator.peers import environment
from hydra_actuator.peers.environment import NotInstalled, Peer, PEERS
from hydra_actuator.peers.ours import run_ours
from hydra_actuator.peers.work import judge, Measured, WORK

STEPS, PATIENCE = 20000, 300.0
OURS = {'hydra_actuator': 2, '  with one pass': 1}      # name of the row, passes


class Row(NamedTuple):
    """A solver's runs, or why there are none."""

    name: str
    runs: tuple[Measured, ...]
    reason: str = ''


def compare(folder: Path, rounds: int = 5, peers: tuple[Peer, ...] = PEERS,
            progress: Callable[[float], None] = lambda share: None) -> list[Row]:
    """Return rows of this package, first, and of each peer, installed below a folder."""
    pythons, reasons = {}, {}
    for k, peer in enumerate(peers):
        try:
            pythons[peer.name] = environment.python_of(peer, folder)
        except NotInstalled as error:
            reasons[peer.name] = f'cannot be installed: {error}'
        progress(0.5 * (k + 1) / len(peers))
    runs: dict[str, list[Measured]] = {name: [] for name in (*OURS, *pythons)}
    for k in range(rounds):
        for name, passes in OURS.items():
            runs[name].append(run_ours(STEPS, passes))
        for peer in peers:
            if peer.name in pythons and peer.name not in reasons:
                try:
                    runs[peer.name].append(run_peer(peer, pythons[peer.name]))
                except NotInstalled as error:
                    reasons[peer.name] = f'does not run here: {error}'
        progress(0.5 + 0.5 * (k + 1) / rounds)
    return [Row(name, tuple(runs[name])) for name in OURS] + [
        Row(peer.name, tuple(runs.get(peer.name, ())), reasons.get(peer.name, ''))
        for peer in peers]


def run_peer(peer: Peer, python: Path) -> Measured:
    """Return one run of a peer; NotInstalled with its complaint if it fails."""
    script = Path(__file__).with_name(peer.script)
    work = {**WORK, 'steps': peer.steps}
    with tempfile.TemporaryDirectory() as place:
        try:
            done = subprocess.run(
                [str(python.absolute()), str(script), json.dumps(work)], cwd=place,
                env=environment.clean_environment(), capture_output=True, text=True,
                timeout=PATIENCE)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise NotInstalled(f'{type(error).__name__}: {error}'[:200]) from error
    if done.returncode:
        raise NotInstalled(environment.last_line(done.stderr))
    return judge(json.loads(done.stdout.splitlines()[-1]))


def lines(rows: list[Row]) -> list[str]:
    """Return the table as text; the rows of this package come first."""
    ours = [row.runs for row in rows[:len(OURS)]]
    told = [f'one line of {WORK["cells"]} reaches, a valve closes; one core, '
            f'{len(ours[0])} rounds',
            f'{"":<16}{"version":>10}{"million node updates/s":>24}{"ours over it":>14}'
            f'{"one pass":>10}{"error of the rise":>19}']
    for row in rows:
        if row.reason:
            told.append(f'{row.name:<16}{row.reason}')
            continue
        updates = statistics.median(run.updates for run in row.runs)
        two, one = (statistics.median(
            mine.updates / run.updates for mine, run in zip(runs, row.runs)) for runs in ours)
        told.append(f'{row.name:<16}{row.runs[0].version:>10}{updates / 1e6:24.3f}{two:14.2f}'
                    f'{one:10.2f}{row.runs[0].error:19.1e}')
    return told
