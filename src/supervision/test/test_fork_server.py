"""A program in a child of the preloaded process behaves as in its client, and so does the client."""

import array
import json
import os
import select
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from supervision.fork_client import FORK_SERVER
from supervision.fork_server import start_fork_server

SECONDS = 10.0
PROGRAM = """
import os, random, signal, sys, time
IMPORTED_BY = os.getpid()
def report(text):
    where = "here" if IMPORTED_BY == os.getpid() else "forked"
    print(where, text, os.environ["WORD"], os.getcwd(), *sys.argv[1:], sys.stdin.read(), flush=True)
    print("to stderr", file=sys.stderr)
    sys.exit(7)
def wait():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(3))
    print(os.getpid(), os.getppid(), flush=True)
    time.sleep(60)
def draw():
    print(random.random())
"""
START = "from supervision.fork_client import run_in_fork_server; run_in_fork_server(*{!r}); print('alone')"
STARTER = """
import sys
from supervision.fork_server import start_fork_server
from supervision.interruption import leave, exit_when_interrupted
exit_when_interrupted()
print(start_fork_server([]).pid, flush=True)
sys.stdin.read()
leave(4)
"""


@pytest.fixture
def modules(tmp_path, monkeypatch):
    (tmp_path / "program.py").write_text(PROGRAM)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), *sys.path]))


@pytest.fixture
def server(modules, monkeypatch):
    monkeypatch.setenv(FORK_SERVER, "")  # and taken back afterwards
    process = start_fork_server(["no_such_module", "program", "program:no_such_function"])
    name = os.environ[FORK_SERVER]
    wait_until(lambda: is_there(name))
    yield process, name
    process.kill()
    process.wait()


def is_there(name):
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as probe:
        return probe.connect_ex(f"\0{name}") == 0


def has_ended(process):
    """Also if nobody has asked yet how it did."""
    try:
        return process.status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


def wait_until(is_so):
    deadline = time.monotonic() + SECONDS
    while not is_so():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def start(name, *call, words=(), **options):
    streams = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    environment = {**os.environ, "WORD": "word", FORK_SERVER: name}
    command = [sys.executable, "-c", START.format(call), *words]
    return subprocess.Popen(command, env=environment, text=True, **{**streams, **options})


def test_a_forked_child_has_the_clients_command_line_environment_folder_streams_and_exit_code(
    server, tmp_path
):
    process = start(server[1], "program:report", "called", words=["text"], cwd=tmp_path)
    out, error = process.communicate("typed", timeout=SECONDS)
    assert out == f"forked called word {tmp_path} text typed\n"
    assert error == "to stderr\n"
    assert process.returncode == 7


def test_a_server_may_run_behind_other_words(modules, monkeypatch):
    """As with other mounts."""
    monkeypatch.setenv(FORK_SERVER, "")
    process = start_fork_server(["program"], ["env", "OF_PREFIX=1"])
    name = os.environ[FORK_SERVER]
    try:
        wait_until(lambda: is_there(name))
        assert b"OF_PREFIX=1" in Path(f"/proc/{process.pid}/environ").read_bytes()
        client = start(name, "program:draw")
        assert float(client.communicate(timeout=SECONDS)[0]) >= 0.0
    finally:
        process.kill()
        process.wait()


@pytest.mark.parametrize("name", ["", "no_such_server"])
def test_without_a_server_the_program_runs_in_its_own_process(modules, name):
    assert start(name, "program:draw").communicate(timeout=SECONDS)[0] == "alone\n"


def test_a_program_that_is_imported_by_the_way_does_not_wait_for_all_that_is_prepared(
    modules, tmp_path, monkeypatch
):
    """As the description of the robot, which roslaunch needs before it starts the first node."""
    (tmp_path / "node.py").write_text("import program\ndef report(): program.report('node')\n")
    step = "import pathlib, time\ndef take(): time.sleep(0.0 if pathlib.Path('hurry').exists() else 0.05)\n"
    (tmp_path / "step.py").write_text(step)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(FORK_SERVER, "")
    server = start_fork_server(["node", *["step:take"] * 1000])
    address = os.environ[FORK_SERVER]
    try:
        wait_until(lambda: is_there(address))
        node = start(address, "node:report", stdin=subprocess.DEVNULL)
        for _ in range(2):  # a node that did not wait would have ended before the second one
            program = start(address, "program:report", "program")
            assert program.communicate("", timeout=SECONDS)[0] == f"forked program word {tmp_path} \n"
        assert node.poll() is None
        (tmp_path / "hurry").touch()
        assert node.communicate(timeout=SECONDS)[0] == f"forked node word {tmp_path} \n"
    finally:
        server.kill()
        server.wait()


def test_a_server_that_dies_before_the_answer_counts_as_absent(modules):
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        listener.bind("\0dying_server")
        listener.listen()
        process = start("dying_server", "program:draw")
        listener.accept()[0].close()
        assert process.communicate(timeout=SECONDS)[0] == "alone\n"


def test_a_child_starts_only_when_signals_are_forwarded(server, tmp_path):
    order = {
        "call": ["program:draw"],
        "argv": [""],
        "path": sys.path,
        "environment": {},
        "folder": str(tmp_path),
    }
    reading, writing = os.pipe()
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as client, os.fdopen(reading) as output:
        client.settimeout(SECONDS)
        client.connect(f"\0{server[1]}")
        streams = array.array("i", [0, writing, 2])
        client.sendmsg([json.dumps(order).encode()], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, streams)])
        os.close(writing)
        child = psutil.Process(int(client.recv(100)))
        time.sleep(0.2)
        assert child.is_running() and not select.select([output], [], [], 0.0)[0]
        client.close()
        assert output.read() == ""
        wait_until(lambda: has_ended(child))


def test_termination_signals_are_forwarded(server):
    process = start(server[1], "program:wait")
    process.stdout.readline()
    process.terminate()
    assert process.wait(SECONDS) == 3


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_the_client_exits_with_the_signal_of_its_child(server, number):
    process = start(server[1], "program:wait")
    child = int(process.stdout.readline().split()[0])
    os.kill(child, number)
    assert process.wait(SECONDS) == (-number if number == signal.SIGKILL else 3)


def test_the_child_dies_with_its_client(server):
    process = start(server[1], "program:wait")
    child = psutil.Process(int(process.stdout.readline().split()[0]))
    process.kill()
    wait_until(lambda: has_ended(child))


def test_a_child_outlives_the_server_and_still_receives_signals(server):
    process = start(server[1], "program:wait")
    child = psutil.Process(int(process.stdout.readline().split()[0]))
    server[0].kill()
    server[0].wait()
    time.sleep(0.1)
    assert child.is_running() and process.poll() is None
    process.terminate()
    wait_until(lambda: has_ended(child))
    assert process.wait(SECONDS) == -signal.SIGKILL  # how, only the server knew


def test_ps_shows_it_under_its_own_command_line(server):
    process = start(server[1], "program:wait", words=["__name:=amcl"])
    child = psutil.Process(int(process.stdout.readline().split()[0]))
    assert "__name:=amcl" in child.cmdline()
    process.kill()


def test_each_child_draws_different_random_numbers(server):
    drawn = {start(server[1], "program:draw").communicate(timeout=SECONDS)[0] for _ in range(3)}
    assert len(drawn) == 3


def test_malformed_and_missing_requests_do_not_end_the_server(server):
    for answer in (b"nonsense", b"[1]", None):
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as client:
            client.connect(f"\0{server[1]}")
            if answer is not None:
                client.send(answer)
                client.settimeout(SECONDS)
                assert client.recv(100) == b""
    assert start(server[1], "program:draw").communicate(timeout=SECONDS)[0] != "alone\n"


def test_the_server_ends_with_the_process_that_started_it(modules):
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    process = subprocess.Popen([sys.executable, "-c", STARTER], text=True, **streams)
    server = psutil.Process(int(process.stdout.readline()))
    process.kill()
    wait_until(lambda: has_ended(server))


@pytest.mark.parametrize("ask, code", [(subprocess.Popen.terminate, 130), (lambda it: it.stdin.close(), 4)])
def test_the_server_has_ended_when_its_parent_has_exited_even_if_it_was_busy(modules, ask, code):
    streams = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    process = subprocess.Popen([sys.executable, "-c", STARTER], text=True, **streams)
    server = psutil.Process(int(process.stdout.readline()))
    server.suspend()
    ask(process)
    assert process.wait(SECONDS) == code
    assert has_ended(server)
