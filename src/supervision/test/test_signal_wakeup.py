import signal
import subprocess
import sys

import pytest

# Its main thread waits, and its others start threads, which unblocks signals each time.
WAITING = """
import sys, threading
from supervision.interruption import raise_when_interrupted

def start_threads():
    while True:
        thread = threading.Thread(target=lambda: sum(range(2000)))
        thread.start()
        thread.join()

raise_when_interrupted()
for _ in range(6):
    threading.Thread(target=start_threads, daemon=True).start()
print("waits", flush=True)
threading.Event().wait()
"""
DEADLINE = 20.0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_taken_by_another_thread_wakes_a_waiting_main_thread(number):
    command = [sys.executable, "-c", WAITING]
    for _ in range(8):  # one in four was not received
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            assert process.stdout.readline() == b"waits\n"
            process.send_signal(number)
            try:
                _, output = process.communicate(timeout=DEADLINE)
            finally:
                process.kill()
            assert b"RunInterruptedError" in output
