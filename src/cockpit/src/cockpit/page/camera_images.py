"""A window with camera images."""

from typing import Any, Dict, Optional

import numpy as np

from cockpit.page.window_column import ColumnWindow, WindowColumn


class CameraWindow:
    """A window that exists while there are images to show.

    Args:
        gui: The gui of viser.
        windows: Opens the window.
    """

    def __init__(self, gui, windows: WindowColumn):
        self._gui, self._windows = gui, windows
        self._window: Optional[ColumnWindow] = None
        self._images: Dict[str, Any] = {}
        self._shown: Dict[str, int] = {}

    def show(self, pictures: Dict[str, np.ndarray]) -> None:
        """Show images.

        Args:
            pictures: Newest image (rows, columns, 3), uint8, of each topic.
        """
        if set(pictures) != set(self._images):
            self._rebuild(pictures)
        for topic, picture in pictures.items():
            if self._shown.get(topic) != id(picture):
                self._shown[topic] = id(picture)
                self._images[topic].image = picture

    def _rebuild(self, pictures: Dict[str, np.ndarray]) -> None:
        if self._window is not None:
            self._windows.remove(self._window)
        self._window, self._images, self._shown = None, {}, {}
        if pictures:
            self._window = self._windows.open("Cameras")
            with self._window:
                for topic, picture in sorted(pictures.items()):
                    self._images[topic] = self._gui.add_image(picture, label=topic, jpeg_quality=70)
