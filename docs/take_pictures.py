#!/usr/bin/env python3
"""Take the pictures in docs/images again, from runs with the sources as they are now.

It needs the workspace with ./scripts/setup.sh --dev, and for the maps of recorded logs their bags, NAME*.bag:

    .venv/bin/python3 docs/take_pictures.py                      # all but the maps of logs
    .venv/bin/python3 docs/take_pictures.py --logs FOLDER slam_aces.png
"""

import argparse
import contextlib
import importlib.util
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Optional, Tuple

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs/images"
sys.path[:0] = [str(path) for path in ROOT.glob("src/*/src")] + [str(ROOT / "tests/shared")]

from browser import Browser, Tab  # noqa: E402
from docking_animation import save_docking  # noqa: E402
from editor_animation import save_editor  # noqa: E402
from import_pictures import save_imports  # noqa: E402

from run_report.picture import save_animation  # noqa: E402

SEED = "5"
MISSION = (str(ROOT / "scripts/home_service.sh"), "--seed", SEED)
SERVICE = (str(ROOT / "scripts/service.sh"), "--seed", SEED, "--dock", "-1.5", "-3.2", "1.57")
REQUESTS = (
    ("deliver cup from pickup to dropoff", "--by", "+20min"),
    ("go pickup",),
    ("patrol dropoff pickup 2 times", "--priority", "2"),
    ("deliver book from dropoff to pickup", "--by", "+1min"),
)
PAGE_SECONDS, MISSION_SECONDS, FRAME_SECONDS = 120.0, 240.0, 0.7
GIF_SIZE, TOOLS_SIZE, SERVICE_SIZE = (1160, 700), (1400, 1250), (1400, 800)
GIF_SCALE, GIF_LENGTH = 0.7, 9.0
# The notice of viser about machines without a graphics card.
DISMISS = "document.querySelectorAll('.mantine-Notification-closeButton').forEach((each) => each.click())"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="files in docs/images (default: all)")
    parser.add_argument("--logs", type=Path, help="folder of the bags of the logs that are mapped")
    options = parser.parse_args()
    unknown = sorted(set(options.names) - set(TAKERS))
    if unknown:
        parser.error(f"unknown: {', '.join(unknown)}; expected some of {', '.join(TAKERS)}")
    for name in options.names or TAKERS:
        if name in LOGS and options.logs is None:
            print(f"{name}: left as it is: give the folder of its bag with --logs")
            continue
        TAKERS[name](IMAGES / name, options.logs)
        print(f"{name}: {(IMAGES / name).stat().st_size / 1000:.0f} KB")
    return 0


def take_run(path: Path, _logs: Optional[Path]) -> None:
    """Take the animation of a mission."""
    with mission_folder("--gif") as folder:
        shutil.copy(folder / "run.gif", path)


def take_report(path: Path, _logs: Optional[Path]) -> None:
    """Take the report of a mission."""
    with mission_folder() as folder, Browser() as browser:
        page = browser.open((folder / "report.html").as_uri(), 1200, 1060)
        page.wait_for("success")
        page.screenshot(path)


def take_docking(path: Path, _logs: Optional[Path]) -> None:
    """Take the animation of a docking, or a picture of it."""
    save_docking(path)


def take_editor(path: Path, _logs: Optional[Path]) -> None:
    """A home drawn in the editor, and its mission."""
    save_editor(path, photograph)


def take_imports(path: Path, _logs: Optional[Path]) -> None:
    """Take the picture of imported plans."""
    save_imports(path, ROOT / "map/home.yaml")


def take_cockpit(path: Path, _logs: Optional[Path]) -> None:
    """Take the cockpit beside a mission, as an animation."""
    with cockpit_page(GIF_SIZE) as page:
        page.click("Drive")
        frames: List[Image.Image] = []
        deadline = time.monotonic() + MISSION_SECONDS
        while "errand: delivered" not in page.text() and time.monotonic() < deadline:
            frames.append(photograph(page))
            time.sleep(FRAME_SECONDS)
        frames += [photograph(page)] * 2
    save_animation(path, frames, GIF_LENGTH)


def take_tools(path: Path, _logs: Optional[Path]) -> None:
    """Take the cockpit with two tools beside a mission."""
    with cockpit_page(TOOLS_SIZE) as page:
        page.click("Tools")
        page.click("Plot")
        for number in ("/odom/twist/twist/linear/x", "/odom/twist/twist/angular/z"):
            page.fill_in("or type it", number)
            page.click("Add")
            page.wait_for(number)
        page.tick("Console")
        time.sleep(12.0)
        page.evaluate("document.querySelector('.uplot').scrollIntoView({block: 'end'})")
        page.evaluate("[...document.querySelectorAll('table')].pop().scrollIntoView({block: 'end'})")
        page.screenshot(path)


def take_service(path: Path, _logs: Optional[Path]) -> None:
    """Take the cockpit beside a service with a queue."""
    with tempfile.TemporaryDirectory() as state, cockpit_page(
        SERVICE_SIZE, *SERVICE, "--state", state
    ) as page:
        request = [str(ROOT / "scripts/request.sh"), "--state", state]
        for words in REQUESTS:
            subprocess.run([*request, *words], check=True, stdout=subprocess.DEVNULL)
        page.wait_for("underway", "queued", "%", seconds=PAGE_SECONDS)
        time.sleep(6.0)
        page.screenshot(path)


def take_map(path: Path, logs: Optional[Path]) -> None:
    """Take the map of a recorded log."""
    assert logs is not None
    spec = importlib.util.spec_from_file_location("slam", ROOT / "tests/benchmarks/slam.py")
    assert spec is not None and spec.loader is not None
    benchmark = importlib.util.module_from_spec(spec)
    sys.modules["slam"] = benchmark
    spec.loader.exec_module(benchmark)
    bag = min(logs.glob(f"*{LOGS[path.name]}*.bag"))
    with tempfile.TemporaryDirectory() as folder:
        stem = Path(folder) / "log"
        trajectory = stem.with_suffix(".tum")
        replay = [sys.executable, benchmark.REPLAY, bag, "--map", stem, "--trajectory", trajectory]
        subprocess.run(list(map(str, replay)), check=True)
        benchmark.draw(stem)
        shutil.copy(stem.with_suffix(".png"), path)


@contextlib.contextmanager
def mission_folder(*options: str) -> Iterator[Path]:
    """Carry out the mission; yield its run folder."""
    with tempfile.TemporaryDirectory() as output:
        subprocess.run([*MISSION, *options, "--output", output], check=True, stdout=subprocess.DEVNULL)
        yield next(Path(output).iterdir())


@contextlib.contextmanager
def cockpit_page(size: Tuple[int, int], *command: str) -> Iterator[Tab]:
    """Yield the page of a command, by default of the mission, that has just started; end it afterwards."""
    with tempfile.TemporaryDirectory() as output, Browser() as browser:
        run = subprocess.Popen(
            [*(command or MISSION), "--web", "--output", output],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
        )
        assert run.stdout is not None
        try:
            url = next(filter(None, (re.search(r"cockpit: (http://\S+)", line) for line in run.stdout)))[1]
            page = browser.open(url, *size)
            page.wait_for("/scan", "/map", seconds=PAGE_SECONDS)
            page.evaluate(DISMISS)
            yield page
        finally:
            os.killpg(run.pid, signal.SIGINT)
            run.communicate()


def photograph(page: Tab) -> Image.Image:
    """Return the page as an image of the size of the animation."""
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        page.screenshot(file.name)
        picture = Image.open(io.BytesIO(Path(file.name).read_bytes())).convert("RGB")
    size = round(GIF_SCALE * picture.width), round(GIF_SCALE * picture.height)
    return picture.resize(size, Image.Resampling.LANCZOS)


# The name of each log whose map is shown.
LOGS = {"slam_aces.png": "aces", "slam_fr079.png": "fr079", "slam_killian.png": "killian"}
TAKERS: Dict[str, Callable[[Path, Optional[Path]], None]] = {
    "run.gif": take_run,
    "report.png": take_report,
    "cockpit.gif": take_cockpit,
    "editor.gif": take_editor,
    "imports.png": take_imports,
    "docking.gif": take_docking,
    "docking.png": take_docking,
    "cockpit_tools.png": take_tools,
    "service.png": take_service,
    **{name: take_map for name in LOGS},
}


if __name__ == "__main__":
    sys.exit(main())
