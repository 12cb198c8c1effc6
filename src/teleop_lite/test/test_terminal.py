import os
import pty
import subprocess
import sys
import termios
from pathlib import Path

import pytest

from teleop_lite.terminal import CTRL_C, NoKeysError, Pipe, Terminal

HOLDS_TERMINAL = """
import os
from teleop_lite.terminal import Terminal
with Terminal(0) as terminal:
    os.write(1, b"ready")
    terminal.read(20.0)
"""


@pytest.fixture
def terminal_pair():
    ours, theirs = pty.openpty()
    yield ours, theirs
    for descriptor in (ours, theirs):
        try:
            os.close(descriptor)
        except OSError:
            continue


def test_keys_arrive_one_by_one_without_newline_and_echo(terminal_pair):
    ours, theirs = terminal_pair
    with Terminal(theirs) as terminal:
        os.write(ours, b"i\r")
        assert terminal.read(1.0) == "i\r"
        assert terminal.read(0.0) == ""


def test_ctrl_c_is_a_key_of_the_own_terminal():
    child, keyboard = pty.fork()
    if child == 0:
        with Terminal(0) as terminal:
            os.write(1, b"ready")
            os._exit(7 if terminal.read(10.0) == CTRL_C else 1)
    assert os.read(keyboard, 10) == b"ready"
    os.write(keyboard, CTRL_C.encode())
    assert os.WEXITSTATUS(os.waitpid(child, 0)[1]) == 7
    os.close(keyboard)


def test_ctrl_c_on_another_session_s_terminal_reaches_the_process_that_started_the_node():
    child, keyboard = pty.fork()  # as roslaunch, which starts nodes in new sessions
    if child == 0:
        node = [sys.executable, "-c", HOLDS_TERMINAL]
        with subprocess.Popen(node, start_new_session=True) as running:
            try:
                running.wait(10.0)
            except KeyboardInterrupt:
                running.kill()
                os._exit(7)
        os._exit(1)
    assert os.read(keyboard, 10) == b"ready"
    os.write(keyboard, CTRL_C.encode())
    assert os.WEXITSTATUS(os.waitpid(child, 0)[1]) == 7
    os.close(keyboard)


def test_the_terminal_is_restored_after_an_exception(terminal_pair):
    before = termios.tcgetattr(terminal_pair[1])
    with pytest.raises(SystemExit), Terminal(terminal_pair[1]):
        assert termios.tcgetattr(terminal_pair[1]) != before
        raise SystemExit(143)
    assert termios.tcgetattr(terminal_pair[1]) == before


def test_a_closed_terminal_counts_as_ctrl_c(terminal_pair):
    ours, theirs = terminal_pair
    with Terminal(theirs) as terminal:
        os.close(ours)
        assert terminal.read(1.0) == CTRL_C


def test_a_pipe_returns_complete_lines_and_the_rest_at_its_end():
    theirs, ours = os.pipe()
    pipe = Pipe(theirs)
    assert pipe.read() == ""
    os.write(ours, b"i:1 j:2\nk:")
    assert pipe.read() == "i:1 j:2"
    assert not pipe.is_at_end
    os.write(ours, b"3")
    os.close(ours)
    assert pipe.read() == "k:3"
    assert pipe.is_at_end
    os.close(theirs)


def test_a_file_that_is_no_terminal_is_refused_with_the_reason():
    with Path(os.devnull).open() as nothing, pytest.raises(NoKeysError, match="no keyboard here"):
        Terminal(nothing.fileno())
