import os
import pty
import termios
from pathlib import Path

import pytest

from teleop_lite.terminal import CTRL_C, NoKeysError, Pipe, Terminal


@pytest.fixture
def terminal_pair():
    ours, theirs = pty.openpty()
    yield ours, theirs
    for descriptor in (ours, theirs):
        try:
            os.close(descriptor)
        except OSError:
            continue


def test_keys_arrive_one_by_one_without_a_newline_and_unseen(terminal_pair):
    ours, theirs = terminal_pair
    with Terminal(theirs) as terminal:
        os.write(ours, b"i\x03")
        assert terminal.read(1.0) == "i" + CTRL_C
        assert terminal.read(0.0) == ""


def test_the_terminal_is_restored_whatever_happens(terminal_pair):
    before = termios.tcgetattr(terminal_pair[1])
    with pytest.raises(SystemExit), Terminal(terminal_pair[1]):
        assert termios.tcgetattr(terminal_pair[1]) != before
        raise SystemExit(143)
    assert termios.tcgetattr(terminal_pair[1]) == before


def test_a_terminal_that_is_gone_counts_as_ctrl_c(terminal_pair):
    ours, theirs = terminal_pair
    with Terminal(theirs) as terminal:
        os.close(ours)
        assert terminal.read(1.0) == CTRL_C


def test_a_pipe_gives_whole_lines_and_at_its_end_the_rest():
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


def test_what_is_no_terminal_is_refused_in_a_sentence():
    with Path(os.devnull).open() as nothing, pytest.raises(NoKeysError, match="no keyboard here"):
        Terminal(nothing.fileno())
