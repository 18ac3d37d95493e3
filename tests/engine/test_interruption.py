"""Ctrl-C stops a run between two looks at the world, with a KeyboardInterrupt and nothing worse."""

import os
import signal
import threading
import time

import pytest

from engine import rooms, simulate


def test_ctrl_c_in_the_kernel_raises_a_keyboard_interrupt():
    simulate(rooms.lin_room(N=20, time_limit=0.1))  # compiled
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    before, begin = signal.getsignal(signal.SIGINT), time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulate(rooms.lin_room(v_d=0.6, N=300, seed=1))
    assert time.monotonic() - begin < 30.0, "it was not interrupted but ran to its end"
    assert signal.getsignal(signal.SIGINT) is before


def test_a_run_in_a_thread_leaves_signals_alone():
    found = []
    thread = threading.Thread(target=lambda: found.append(simulate(rooms.lin_room(N=5, time_limit=0.1))))
    thread.start()
    thread.join()
    assert found[0].outcome == "time_limit"
