"""What ``render`` shows of an episode: a picture, or a page in the browser."""

from typing import TYPE_CHECKING, Optional

import numpy as np

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.task import Overlay
from home_service_gym.top_view import TopView
from planar import SettingsError
from sim_bridge import RobotProfile

if TYPE_CHECKING:
    from home_service_gym.browser_window import BrowserWindow

PICTURE, PAGE = "rgb_array", "human"
MODES = [PICTURE, PAGE]


class EpisodeRenderer:
    """In one of the modes, or in none; ``rate``: control periods a second. Raises SettingsError."""

    def __init__(self, mode: Optional[str], robot: RobotProfile, rate: int):
        if mode not in (None, *MODES):
            raise SettingsError(f"render_mode must be {', '.join(MODES)} or None, got {mode!r}")
        self._mode, self._robot, self._rate = mode, robot, rate
        self._picture: Optional[TopView] = None
        self._window: Optional[BrowserWindow] = None

    def show(
        self, simulation: EpisodeSimulation, state: EpisodeState, overlay: Overlay
    ) -> Optional[np.ndarray]:
        """The picture, (H, W, 3), uint8; of a page nothing."""
        if self._mode == PICTURE:
            if self._picture is None or self._picture.simulation is not simulation:
                self._picture = TopView(simulation)
            return self._picture.draw(state, overlay)
        if self._mode == PAGE:
            self._window = self._window or _opened(self._robot, self._rate)
            self._window.show(simulation, state, overlay)
        return None

    @property
    def is_live(self) -> bool:
        """Whether every moment is shown without being asked for, as Gymnasium has it for people."""
        return self._mode == PAGE

    def close(self) -> None:
        if self._window is not None:
            self._window.close()
        self._picture = self._window = None


def _opened(robot: RobotProfile, rate: int) -> "BrowserWindow":
    try:
        from home_service_gym.browser_window import BrowserWindow
    except ImportError as error:
        raise SettingsError(
            f"render_mode human needs the cockpit: ./scripts/setup.sh --web ({error})"
        ) from None
    return BrowserWindow(robot, rate)
