import os
import signal
import subprocess
import sys

import pytest

SWALLOWING = """
import time
print("importing", flush=True)
try:
    time.sleep(30.0)
except BaseException:
    pass
def main():
    print("reached")
"""
PLAIN = """
import signal
def main(text):
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    return text
"""


def start(folder, code, *arguments):
    (folder / "some_module.py").write_text(code)
    call = f"from planar_ros.node.entry import call; print(call('some_module:main', *{arguments}))"
    return subprocess.Popen(
        [sys.executable, "-c", call],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), *sys.path])},
        stdout=subprocess.PIPE,
        text=True,
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_process_whose_imports_catch_everything(tmp_path, number):
    process = start(tmp_path, SWALLOWING)
    assert process.stdout.readline() == "importing\n"
    process.send_signal(number)
    assert process.communicate(timeout=10.0)[0] == ""
    assert process.returncode == 128 + number


def test_the_function_receives_its_arguments_and_default_signal_handlers(tmp_path):
    process = start(tmp_path, PLAIN, "hello")
    assert process.communicate(timeout=10.0)[0] == "hello\n"
