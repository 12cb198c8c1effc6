#!/usr/bin/env python3
"""What the cockpit costs: how soon its page is up, processor and memory, and the pace of a mission beside it.

python3 tests/benchmarks/cockpit_cost.py [--seconds 20] [--clients 10] [--mission]

The clients are sockets that take in what a browser would; what a browser itself needs to draw is not counted.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import msgspec.msgpack
import psutil
import viser
from websockets.sync.client import connect

ROOT = Path(__file__).resolve().parents[2]
DEADLINE = 120.0
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 5.0],
    "fov": 1.0,
    "near": 0.1,
    "far": 100.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0, help="of each measurement (default: 20)")
    parser.add_argument("--clients", type=int, default=10, help="at once, in the last (default: 10)")
    parser.add_argument("--mission", action="store_true", help="also the mission's pace, with and without")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(options, Path(folder))
        if options.mission:
            compare_missions(Path(folder))
    return 0


def measure(options: argparse.Namespace, folder: Path) -> None:
    """Beside a robot that stands, at real time."""
    with Command(["test_navigation.sh", "--web", "--output", str(folder)]) as run:
        url = run.wait_for("cockpit: http").partition(": ")[2].strip()
        page = run.process_with("cockpit.ros.node")
        run.wait_for("Ctrl-C ends")
        print(f"page up {run.seconds_of_line('cockpit: http') - page.create_time():.2f} s after its start")
        time.sleep(5.0)
        tell("no client", page, options.seconds)
        for count in (1, options.clients):
            with Clients(url, count) as clients:
                time.sleep(10.0)  # the whole world is sent first
                before = clients.messages()
                tell(f"{count} client(s)", page, options.seconds)
                rates = [(after - b) / options.seconds for b, after in zip(before, clients.messages())]
                print(f"  pictures a second: at least {min(rates):.1f}")


def tell(what: str, page: psutil.Process, seconds: float) -> None:
    before = page.cpu_times()
    time.sleep(seconds)
    after = page.cpu_times()
    used = (after.user - before.user + after.system - before.system) / seconds
    print(f"{what}: {100.0 * used:.1f} % of a core, {page.memory_info().rss / 2**20:.0f} MB")


def compare_missions(folder: Path) -> None:
    """The errand as fast as the nodes keep up, in turn without a page and with one that is looked at."""
    factors = {}
    for is_watched in (False, True):
        words = [
            "home_service.sh",
            "--speed",
            "0",
            "--output",
            str(folder),
            *(["--web"] if is_watched else []),
        ]
        with Command(words) as run:
            if is_watched:
                with Clients(run.wait_for("cockpit: http").partition(": ")[2].strip(), 1):
                    run.wait_for("SUCCESS")
            else:
                run.wait_for("SUCCESS")
            name = run.wait_for("result, report and logs in").rpartition(" in ")[2].strip()
            run.process.wait(DEADLINE)
        result = json.loads((Path(name) / "result.json").read_text())
        factors[is_watched] = result["real_time_factor"]
    ratio = factors[True] / factors[False]
    print(f"mission: {factors[False]:.2f} x real time, with a page {factors[True]:.2f} x, ratio {ratio:.2f}")


class Command:
    """A script of the project, with the lines that it has printed and when."""

    def __init__(self, words):
        self._lines = []
        self.process = subprocess.Popen(
            [str(ROOT / "scripts" / words[0]), *words[1:]], stdout=subprocess.PIPE, text=True
        )
        threading.Thread(target=self._read, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(2)
            self.process.wait(DEADLINE)

    def wait_for(self, text: str) -> str:
        deadline = time.monotonic() + 3.0 * DEADLINE
        while time.monotonic() < deadline:
            for _, line in list(self._lines):
                if text in line:
                    return line
            time.sleep(0.02)
        sys.exit(f"cockpit_cost.py: error: '{text}' was not printed")

    def seconds_of_line(self, text: str) -> float:
        return next(at for at, line in self._lines if text in line)

    def process_with(self, mark: str) -> psutil.Process:
        children = psutil.Process(self.process.pid).children(recursive=True)
        return next(child for child in children if mark in " ".join(child.cmdline()))

    def _read(self):
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.append((time.time(), line))


class Clients:
    """Sockets that take in all that they are sent, as pages of browsers do."""

    def __init__(self, url: str, count: int):
        address, _, token = url.partition("/?token=")
        port = address.rpartition(":")[2]
        self._counts = [0] * count
        self._sockets = [
            connect(
                address.replace("http", "ws") + "/",
                origin=address,  # type: ignore[arg-type]
                additional_headers={"Cookie": f"cockpit_{port}={token}"},
                subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
                max_size=None,
            )
            for _ in range(count)
        ]
        for number, socket in enumerate(self._sockets):
            socket.send(msgspec.msgpack.encode(CAMERA))
            threading.Thread(target=self._take, args=(number, socket), daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for socket in self._sockets:
            socket.close()

    def messages(self):
        """How many each has been sent."""
        return list(self._counts)

    def _take(self, number: int, socket) -> None:
        for _ in socket:
            self._counts[number] += 1


if __name__ == "__main__":
    sys.exit(main())
