#!/usr/bin/env python3
"""Measure the editor of homes: how soon an edit shows, its memory, and how soon a mission runs in a new home.

    python3 tests/benchmarks/home_editor.py [--walls 200] [--pieces 100] [--edits 60] [--json FILE]

* edits: in a large plan, from an input of the mouse to the next frame that the browser has painted [ms], and
  the CPU time of the page's main thread, which is what is left of it on a machine without other load
* memory: proportional set size of all processes of the browser with the cockpit's page [MB], without the
  editor, and with the editor and a large plan in its Home tab
* mission: seconds from an empty page to the success of the mission, a person acting every 0.6 s
* picture: seconds of build_home.sh for a picture of a floor plan with --scale, as a whole process

The cockpit needs a ROS master; one is started. The rows are printed as a table.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Dict, Iterator, List

import numpy as np
import psutil

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/shared"))

from browser import Browser, Tab  # noqa: E402
from editor_hands import EditorHands, draw_home  # noqa: E402
from made_drawings import draw_floor_plan  # noqa: E402
from waiting import wait_until  # noqa: E402

from cockpit.process import FREE_PORT, CockpitProcess  # noqa: E402
from home_builder import FurniturePiece, HomePlan, Wall  # noqa: E402
from home_builder.editor.server import EditorServer  # noqa: E402
from home_builder.editor.session import EditorSession  # noqa: E402
from supervision.ros.node_api import is_master_online  # noqa: E402

PACE_SECONDS, SETTLE_SECONDS = 0.6, 8.0
SIZE = (1400, 860)
# From an event to the frame after the next one: by then the first of them is on the screen.
PAINTED = (
    "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now()))))"
)
# An edit: the press of the mouse on a piece of furniture, a move of 10 pixels, and the release.
EDIT = """(async () => {{
    const shape = document.querySelector('[data-item="furniture/{number}"]').getBoundingClientRect();
    const [x, y] = [shape.x + shape.width / 2, shape.y + shape.height / 2];
    const send = (kind, clientX, clientY) => document.elementFromPoint(clientX, clientY).dispatchEvent(
        new PointerEvent(kind, {{ clientX, clientY, pointerId: 1, bubbles: true, cancelable: true }}));
    svg.setPointerCapture = () => {{}};
    const start = performance.now();
    send('pointerdown', x, y); send('pointermove', x + 10, y); send('pointerup', x + 10, y);
    return await {painted} - start;
}})()"""


def main() -> int:
    options = _options()
    plan = large_plan(options.walls, options.pieces)
    rows: Dict[str, Any] = {"walls": options.walls, "pieces": options.pieces}
    for name, measure in (
        ("edits", lambda: edits(plan, options.edits)),
        ("memory", lambda: memory(plan)),
        ("mission", mission),
        ("picture", picture),
    ):
        if name in options.only:
            rows.update(measure())
    print("\n".join(f"{name:28s} {value}" for name, value in rows.items()))
    if options.json is not None:
        options.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--walls", type=int, default=200)
    parser.add_argument("--pieces", type=int, default=100)
    parser.add_argument("--edits", type=int, default=60, help="number of edits")
    parser.add_argument("--json", type=Path, help="also write the rows to this file")
    every = ("edits", "memory", "mission", "picture")
    parser.add_argument("--only", nargs="+", choices=every, default=every, help="what is measured")
    return parser.parse_args()


def large_plan(walls: int, pieces: int) -> HomePlan:
    """Return a plan with rows of walls and, beside them, rows of furniture."""
    return HomePlan(
        "large",
        tuple(
            Wall((2.0 * (n % 20), 2.0 * (n // 20)), (2.0 * (n % 20) + 1.5, 2.0 * (n // 20)))
            for n in range(walls)
        ),
        tuple(
            FurniturePiece("chair", 4.0 * (n % 10) + 0.7, 2.0 * (n // 10) + 1.0, 0.1, (0.4, 0.4, 0.9))
            for n in range(pieces)
        ),
        start=(-2.0, -2.0),
    )


@contextmanager
def served(folder: Path, plan: HomePlan) -> Iterator[str]:
    """Serve an editor; yields the URL of its page."""
    server = EditorServer(EditorSession(folder, plan))
    threading.Thread(target=server.serve, daemon=True).start()
    try:
        yield server.url
    finally:
        server.close()


def edits(plan: HomePlan, count: int) -> Dict[str, Any]:
    """Return quantiles of the time until an edit is painted."""
    with tempfile.TemporaryDirectory() as folder, Browser() as browser, served(Path(folder), plan) as url:
        page = browser.open(url, *SIZE)
        page.wait_for("saved in", seconds=60.0)
        times: List[float] = []
        cpu = page.thread_seconds()
        for number in range(count):
            edit = EDIT.format(number=number % len(plan.furniture), painted=PAINTED)
            times.append(float(page.evaluate(edit)))
            time.sleep(0.3)
        cpu = page.thread_seconds() - cpu
        assert page.evaluate("done.length") == count, "an edit was lost"
        frames = [
            float(page.evaluate(f"(async () => -performance.now() + await {PAINTED})()")) for _ in range(9)
        ]
    quantiles = np.quantile(times, (0.5, 0.95, 1.0)).round(1).tolist()
    return {
        "edit, median [ms]": quantiles[0],
        "edit, 95 % [ms]": quantiles[1],
        "edit, slowest [ms]": quantiles[2],
        "edit, CPU [ms]": round(1000.0 * cpu / count, 1),
        "two frames alone [ms]": round(float(np.median(frames)), 1),
        "load average": round(os.getloadavg()[0], 1),
    }


def memory(plan: HomePlan) -> Dict[str, Any]:
    """Return the memory of the browser with the cockpit, without and with the editor."""
    with tempfile.TemporaryDirectory() as folder, ros_master(), Browser() as browser:
        home = Path(folder) / "large"
        EditorSession(home, plan).close()
        cockpit = CockpitProcess(FREE_PORT, Path(folder) / "cockpit.log")
        try:
            page = browser.open(cockpit.url, *SIZE)
            page.wait_for("Home", "Tools", seconds=120.0)
            time.sleep(SETTLE_SECONDS)
            before = megabytes()
            open_home_tab(page, home)
            time.sleep(SETTLE_SECONDS)
            after = megabytes()
        finally:
            cockpit.close()
    return {
        "page without editor [MB]": round(before, 1),
        "page with editor [MB]": round(after, 1),
        "ratio": round(after / before, 3),
    }


def open_home_tab(page: Tab, home: Path) -> None:
    """Open the editor of a home in the cockpit, and wait for its drawing."""
    page.click("Home")
    page.fill_in("Folder", str(home))
    page.click("Edit the home")

    def is_drawn():
        page.evaluate("0")  # receives what has happened
        return any(address.endswith("/plan") for address in page.requests)

    wait_until("the editor's plan", is_drawn, 120.0)


@contextmanager
def ros_master() -> Iterator[None]:
    """Start a ROS master on a free port."""
    import socket

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
    master = subprocess.Popen(
        ["roscore", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        wait_until("the ROS master", is_master_online, 60.0)
        yield
    finally:
        master.terminate()
        master.wait()


def megabytes() -> float:
    """Return the proportional set size of the browser that this process has started [MB]."""
    found = [each for each in psutil.Process().children(recursive=True) if "chrom" in each.name()]
    return sum(each.memory_full_info().pss for each in found) / 1e6


def mission() -> Dict[str, Any]:
    """Return the time from an empty page to the success of the mission, at a person's pace."""
    empty = HomePlan("flat")
    with tempfile.TemporaryDirectory() as folder, Browser() as browser, served(Path(folder), empty) as url:
        page = browser.open(url, *SIZE)
        page.wait_for("saved in", seconds=60.0)
        started = time.monotonic()
        hands = EditorHands(page, PACE_SECONDS)
        for _ in draw_home(hands):
            pass
        hands.press_button("try")
        page.wait_for("1 of 1 succeeded", seconds=300.0)
        return {"empty page to success [s]": round(time.monotonic() - started, 1)}


def picture() -> Dict[str, Any]:
    """Return the time of the whole command for a picture."""
    with tempfile.TemporaryDirectory() as folder:
        plan = Path(folder) / "plan.png"
        draw_floor_plan(plan)
        command = [sys.executable, "-m", "home_builder", "build_home", str(plan), "--scale", "0.01"]
        started = time.monotonic()
        subprocess.run([*command, "--output", f"{folder}/home"], check=True, stdout=subprocess.DEVNULL)
        return {"build_home.sh plan.png [s]": round(time.monotonic() - started, 1)}


if __name__ == "__main__":
    sys.exit(main())
