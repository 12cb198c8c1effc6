"""The animation of the editor of homes: a home is drawn, and its mission runs."""

import json
import tempfile
import threading
from pathlib import Path
from typing import Callable, Iterator, List

from browser import Browser, Tab
from PIL import Image

from home_builder.editor.server import EditorServer
from home_builder.editor.session import EditorSession

SIZE, SCALE, FRAME_SECONDS = (1160, 700), 0.6, 0.7
WALLS = ((0, 0), (8, 0), (8, 6), (0, 6), (0, 0), (4, 0), (4, 6))
FURNITURE = (("bed", (1.3, 5)), ("sofa", (6, 0.7)), ("table", (6, 4.8)), ("plant", (7.5, 1.5)))


def save_editor(path: Path, photograph: Callable[[Tab], Image.Image]) -> None:
    """Draw a home in the browser, and save what is seen.

    Args:
        path: GIF to write.
        photograph: Takes a picture of a page.
    """
    with tempfile.TemporaryDirectory() as folder, Browser() as browser:
        server = EditorServer(EditorSession(Path(folder) / "flat"))
        threading.Thread(target=server.serve, daemon=True).start()
        page = browser.open(server.url, *SIZE)
        page.wait_for("saved in", seconds=60.0)
        frames: List[Image.Image] = []
        for _ in _steps(page):
            frames.append(photograph(page).resize([int(side * SCALE) for side in SIZE]))
        server.close()
    first, *others = [frame.convert("P", palette=Image.Palette.ADAPTIVE, colors=32) for frame in frames]
    first.save(path, save_all=True, append_images=others, duration=int(1000 * FRAME_SECONDS), loop=0)


def _steps(page: Tab) -> Iterator[None]:
    """Draw; yields after each step."""
    choose = "document.querySelector('[data-tool={}]').click()"
    page.evaluate(choose.format("wall"))
    for corner in WALLS:
        _click(page, corner)
        yield
    page.evaluate("choose('select')")
    for tool, where in (("door", (4, 3)), ("window", (2, 0)), ("window", (6, 6)), *FURNITURE):
        page.evaluate(choose.format(tool))
        _click(page, where)
        yield
    for name, where in (("bedroom", (1, 2)), ("kitchen", (5, 2))):
        page.evaluate(choose.format("room"))
        _click(page, where)
        page.evaluate(f"change(() => {{ itemOf(chosen).name = {json.dumps(name)}; }})")
        yield
    page.evaluate(choose.format("start"))
    _click(page, (2, 2))
    page.wait_for("saved", "bedroom", "kitchen")
    yield
    page.evaluate("document.getElementById('try').click()")
    yield
    page.wait_for("1 of 1 succeeded", seconds=240.0)
    for _ in range(4):
        yield


def _click(page: Tab, point) -> None:
    x, y = page.evaluate(
        "(([left, top], box) => [box.left + left, box.top + top])"
        f"(toPage({point[0]}, {point[1]}), svg.getBoundingClientRect())"
    )
    page.click_at(x, y)
