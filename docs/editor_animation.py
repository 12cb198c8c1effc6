"""The animation of the editor of homes: a home is drawn, and its mission runs."""

import tempfile
import threading
from pathlib import Path
from typing import Callable, Iterator, List

from browser import Browser, Tab
from editor_hands import EditorHands, draw_home
from PIL import Image

from home_builder.editor.server import EditorServer
from home_builder.editor.session import EditorSession

SIZE, SCALE, FRAME_SECONDS = (1160, 700), 0.6, 0.7


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
    """Draw, and run the mission; yields after each step."""
    hands = EditorHands(page)
    yield from draw_home(hands)
    hands.press_button("try")
    yield
    page.wait_for("1 of 1 succeeded", seconds=240.0)
    for _ in range(4):
        yield
