"""Rendering of episodes: images, or a page in the browser."""

from typing import TYPE_CHECKING, Optional

import numpy as np

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.task import Overlay
from home_service_gym.top_view import TopView
from planar import SettingsError
from sim_bridge import RobotProfile

if TYPE_CHECKING:
    from home_service_gym.browser_window import BrowserWindow

IMAGE, PAGE = "rgb_array", "human"
MODES = [IMAGE, PAGE]


class EpisodeRenderer:
    """Renders in one mode.

    Args:
        mode: ``rgb_array``, ``human`` or None.
        robot: Robot profile.
        rate: Control rate [Hz].

    Raises:
        SettingsError: The mode is unknown, or the cockpit for ``human`` is not installed.
    """

    def __init__(self, mode: Optional[str], robot: RobotProfile, rate: int):
        if mode not in (None, *MODES):
            raise SettingsError(f"render_mode must be {', '.join(MODES)} or None, got {mode!r}")
        self._mode, self._robot, self._rate = mode, robot, rate
        self._top_view: Optional[TopView] = None
        self._window: Optional[BrowserWindow] = None

    def show(
        self, simulation: EpisodeSimulation, state: EpisodeState, overlay: Overlay
    ) -> Optional[np.ndarray]:
        """Return the image (H, W, 3), uint8; None if the mode is not ``rgb_array``."""
        if self._mode == IMAGE:
            if self._top_view is None or self._top_view.simulation is not simulation:
                self._top_view = TopView(simulation)
            return self._top_view.draw(state, overlay)
        if self._mode == PAGE:
            self._window = self._window or _open_window(self._robot, self._rate)
            self._window.show(simulation, state, overlay)
        return None

    @property
    def is_live(self) -> bool:
        """Whether every step is rendered automatically, as Gymnasium requires of the mode ``human``."""
        return self._mode == PAGE

    def close(self) -> None:
        if self._window is not None:
            self._window.close()
        self._top_view = self._window = None


def _open_window(robot: RobotProfile, rate: int) -> "BrowserWindow":
    try:
        from home_service_gym.browser_window import BrowserWindow
    except ImportError as error:
        raise SettingsError(
            f"render_mode human needs the cockpit: ./scripts/setup.sh --web ({error})"
        ) from None
    return BrowserWindow(robot, rate)
