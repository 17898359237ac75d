# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C waits for the end of a piece of work, and is never lost."""

from contextlib import suppress
import ctypes
import signal
import sys
import threading

from hydra_actuator import interruption
from hydra_actuator.interruption import Interruption
import pytest


@pytest.fixture(autouse=True)
def python_handler():
    """Have Python's own handler, which a process started in the background has not."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt():
    signal.raise_signal(signal.SIGINT)


def test_an_interrupt_waits_until_it_is_asked_for():
    done = []
    with pytest.raises(KeyboardInterrupt), Interruption() as held:
        held.hold()
        held.raise_if_asked()
        interrupt()
        done.append('rest of the piece')
        held.raise_if_asked()
        done.append('next piece')
    assert done == ['rest of the piece']


def test_an_interrupt_nobody_asked_for_comes_at_the_end_of_the_block():
    done = []
    with pytest.raises(KeyboardInterrupt), Interruption() as held:
        held.hold()
        interrupt()
        done.append('closed')
    assert done == ['closed']


def test_an_error_is_not_hidden_by_an_interrupt():
    with pytest.raises(ZeroDivisionError), Interruption() as held:
        held.hold()
        interrupt()
        raise ZeroDivisionError


def test_a_second_interrupt_is_held_at_once_but_not_for_long(monkeypatch):
    done = []
    with pytest.raises(KeyboardInterrupt), Interruption() as held:
        held.hold()
        interrupt()
        interrupt()
        done.append('both held')
        monkeypatch.setattr(interruption, 'PATIENCE', -1.0)
        interrupt()
        done.append('still hanging')
    assert done == ['both held']


def test_before_the_hold_an_interrupt_comes_at_once():
    done = []
    with pytest.raises(KeyboardInterrupt), Interruption():
        interrupt()
        done.append('too far')
    assert done == []


def test_an_interrupt_that_was_swallowed_comes_at_the_hold():
    done = []
    with pytest.raises(KeyboardInterrupt), Interruption() as held:
        with suppress(KeyboardInterrupt):
            interrupt()
        held.hold()
        done.append('too far')
    assert done == []


def test_an_interrupt_that_became_an_error_is_an_interrupt():
    with pytest.raises(KeyboardInterrupt), Interruption():
        try:
            interrupt()
        except KeyboardInterrupt:
            raise RuntimeError from None


def test_a_callback_from_c_that_swallows_an_interrupt_does_so_in_silence(monkeypatch):
    reported = []
    monkeypatch.setattr(sys, 'unraisablehook', lambda told: reported.append(told.exc_type))
    callback = ctypes.CFUNCTYPE(ctypes.c_int)
    with pytest.raises(KeyboardInterrupt), Interruption() as held:
        callback(lambda: 1 // 0)()
        callback(interrupt)()
        held.hold()
    assert reported == [ZeroDivisionError]


def test_python_has_its_own_handler_back_afterwards():
    with Interruption():
        assert signal.getsignal(signal.SIGINT) is not signal.default_int_handler
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize('handler', [signal.SIG_IGN, lambda *_: None])
def test_a_foreign_handler_is_left_alone(handler):
    signal.signal(signal.SIGINT, handler)
    with Interruption():
        assert signal.getsignal(signal.SIGINT) is handler
    assert signal.getsignal(signal.SIGINT) is handler


def test_another_thread_than_the_main_one_can_enter():
    entered = []

    def work():
        with Interruption() as held:
            held.raise_if_asked()
            entered.append(True)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert entered == [True]
