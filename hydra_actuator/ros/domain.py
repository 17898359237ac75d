# SPDX-License-Identifier: Apache-2.0
"""
A ROS domain of one's own on the loopback, kept from others of this machine by a lock file.

Domains 1 to 101 are those whose ports lie below the ephemeral ones on every system; 0 is where
everybody else is.
"""

from collections.abc import Iterator
from contextlib import contextmanager
import fcntl
import os
from pathlib import Path
import random
import tempfile

from hydra_actuator.errors import Failure

DOMAINS = range(1, 102)


@contextmanager
def own_domain() -> Iterator[int]:
    """Hold a free domain id; raises Failure if there is none."""
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        file = _locked(domain)
        if file is not None:
            try:
                yield domain
            finally:
                os.close(file)
            return
    raise Failure('all ROS domains from 1 to 101 are in use here')


@contextmanager
def alone() -> Iterator[int]:
    """Have this process's environment be that of a free domain meanwhile; yield its id."""
    before = dict(os.environ)
    with own_domain() as domain:
        environment = loopback_environment(domain)
        os.environ.clear()
        os.environ.update(environment)
        try:
            yield domain
        finally:
            os.environ.clear()
            os.environ.update(before)


def loopback_environment(domain: int) -> dict[str, str]:
    """Return the environment of a process that speaks on this domain to this machine only."""
    environment = dict(os.environ)
    for name in ('ROS_LOCALHOST_ONLY', 'ROS_STATIC_PEERS', 'ROS_SECURITY_ENABLE'):
        environment.pop(name, None)
    environment['ROS_DOMAIN_ID'] = str(domain)
    environment['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    return environment


def _locked(domain: int) -> int | None:
    """Return the open lock file of a domain, None if another process has it."""
    path = Path(tempfile.gettempdir()) / f'hydra_actuator_ros_domain_{domain}.lock'
    try:
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError:
        return None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(file)
        return None
    return file
