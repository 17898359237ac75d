# SPDX-License-Identifier: Apache-2.0
"""A node that is started by its measurer says why it ended, and leaves nothing behind."""

from pathlib import Path
import time

from hydra_actuator.errors import Failure
from hydra_actuator.ros.child import ChildNode
import pytest


def test_the_end_of_a_node_is_told_with_its_last_words(domain):
    with ChildNode(['-p', 'no.such.parameter:=1', '-p', 'recording.enabled:=maybe:']) as child:
        end = time.monotonic() + 60.0
        with pytest.raises(Failure, match=r'the node ended with code 2; it said: hydra_actuator'):
            while time.monotonic() < end:
                child.check()
                time.sleep(0.02)
        with pytest.raises(Failure, match='recorded nothing'):
            child.recording  # noqa: B018
        assert child.stop() == 2


def test_a_node_ends_with_its_context(domain):
    with ChildNode(['-p', 'autostart:=false']) as child:
        while 'hydra_actuator' not in Path(f'/proc/{child.pid}/cmdline').read_text():
            time.sleep(0.01)
        child.check()
        time.sleep(0.1)
        assert child.processor_time > 0.0
    assert child.processor_time == 0.0
    assert not Path(f'/proc/{child.pid}').exists()
