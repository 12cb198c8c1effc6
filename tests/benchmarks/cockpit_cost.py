#!/usr/bin/env python3
"""What the cockpit costs: how soon its page is up, processor and memory, and the pace of a mission beside it.

python3 tests/benchmarks/cockpit_cost.py [--seconds 20] [--clients 10] [--pairs 5] [--json FILE]

The clients are sockets that take in what a browser would; what a browser itself needs to draw is not counted.
"""

import argparse
import json
import sys
import tempfile
import threading
import time
from contextlib import nullcontext
from pathlib import Path
from typing import Any, Dict, List

import numpy as np
import psutil

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/shared"))
from command import Command  # noqa: E402
from page_client import open_page  # noqa: E402

SCRIPTS = ROOT / "scripts"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0, help="of each measurement (default: 20)")
    parser.add_argument("--clients", type=int, default=10, help="at once, in the last (default: 10)")
    parser.add_argument("--pairs", type=int, default=0, help="also so many missions with and without a page")
    parser.add_argument("--json", type=Path, help="write the figures here")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        figures = measure(options, Path(folder))
        if options.pairs:
            figures["mission"] = compare_missions(options.pairs, Path(folder))
    if options.json:
        options.json.write_text(json.dumps(figures, indent=2) + "\n")
    return 0


def measure(options: argparse.Namespace, folder: Path) -> Dict[str, Any]:
    """Beside a robot that stands, at real time."""
    start = time.time()
    with Command(SCRIPTS / "test_navigation.sh", "--web", "--output", folder) as run:
        url, now = run.url, time.time()
        page = page_of(run)
        figures: Dict[str, Any] = {"up_seconds": now - page.create_time(), "after_command": now - start}
        print(
            f"page up {now - page.create_time():.2f} s after its start, {now - start:.2f} s after the command"
        )
        run.wait_for_line("send goals to")
        time.sleep(5.0)
        figures["no client"] = use_of(page, "no client", options.seconds)
        for count in (1, options.clients):
            with Clients(url, count) as clients:
                time.sleep(10.0)  # the whole world is sent first
                before = clients.messages()
                use = use_of(page, f"{count} client(s)", options.seconds)
                rates = [(after - b) / options.seconds for b, after in zip(before, clients.messages())]
                print(f"  pictures a second: at least {min(rates):.1f}")
                figures[f"{count} clients"] = {**use, "pictures_per_second": min(rates)}
    return figures


def page_of(run: Command) -> psutil.Process:
    children = psutil.Process(run.process.pid).children(recursive=True)
    return next(child for child in children if "cockpit.ros.node" in " ".join(child.cmdline()))


def use_of(page: psutil.Process, what: str, seconds: float) -> Dict[str, float]:
    before = page.cpu_times()
    time.sleep(seconds)
    after = page.cpu_times()
    used = (after.user - before.user + after.system - before.system) / seconds
    megabytes = page.memory_info().rss / 2**20
    print(f"{what}: {100.0 * used:.1f} % of a core, {megabytes:.0f} MB")
    return {"cores": used, "megabytes": megabytes}


def compare_missions(pairs: int, folder: Path) -> Dict[str, Any]:
    """The errand as fast as the nodes keep up, in turn without a page and with one that is looked at."""
    factors: Dict[bool, List[float]] = {False: [], True: []}
    for pair in range(pairs):
        for is_watched in (False, True) if pair % 2 == 0 else (True, False):
            factors[is_watched].append(pace_of_mission(is_watched, folder))
        ratios = np.divide(factors[True], factors[False])
        print(
            f"mission: {factors[False][-1]:.2f} x real time, with a page {factors[True][-1]:.2f} x; "
            f"ratio {ratios[-1]:.2f}, median of {len(ratios)}: {np.median(ratios):.2f}"
        )
    return {"without": factors[False], "with": factors[True], "ratio": float(np.median(ratios))}


def pace_of_mission(is_watched: bool, folder: Path) -> float:
    view = ["--web"] if is_watched else []
    with Command(SCRIPTS / "home_service.sh", "--speed", "0", "--output", folder, *view) as run:
        with Clients(run.url, 1) if is_watched else nullcontext():
            run.wait_for_line("SUCCESS")
        name = run.wait_for_line("result, report and logs in ")
    return json.loads((Path(name) / "result.json").read_text())["real_time_factor"]


class Clients:
    """Sockets that take in all that they are sent, as pages of browsers do."""

    def __init__(self, url: str, count: int):
        self._counts = [0] * count
        self._sockets = [open_page(url) for _ in range(count)]
        for number, socket in enumerate(self._sockets):
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
