"""What ``render`` shows of an episode: a picture, or a page in the browser."""

from typing import TYPE_CHECKING, Optional

import numpy as np

from home_service_gym.drawing import Picture
from home_service_gym.playground import Moment, Playground
from home_service_gym.task import Marks
from planar import SettingsError
from sim_bridge import RobotProfile

if TYPE_CHECKING:
    from home_service_gym.window import Window

PICTURE, PAGE = "rgb_array", "human"
MODES = [PICTURE, PAGE]


class Viewer:
    """In one of the modes, or in none; ``rate``: control periods a second. Raises SettingsError."""

    def __init__(self, mode: Optional[str], robot: RobotProfile, rate: int):
        if mode not in (None, *MODES):
            raise SettingsError(f"render_mode must be {', '.join(MODES)} or None, got {mode!r}")
        self._mode, self._robot, self._rate = mode, robot, rate
        self._picture: Optional[Picture] = None
        self._window: Optional[Window] = None

    def show(self, playground: Playground, moment: Moment, marks: Marks) -> Optional[np.ndarray]:
        """The picture, (H, W, 3), uint8; of a page nothing."""
        if self._mode == PICTURE:
            if self._picture is None or self._picture.playground is not playground:
                self._picture = Picture(playground)
            return self._picture.draw(moment, marks)
        if self._mode == PAGE:
            self._window = self._window or _opened(self._robot, self._rate)
            self._window.show(playground, moment, marks)
        return None

    @property
    def is_live(self) -> bool:
        """Whether every moment is shown without being asked for, as Gymnasium has it for people."""
        return self._mode == PAGE

    def close(self) -> None:
        if self._window is not None:
            self._window.close()
        self._picture = self._window = None


def _opened(robot: RobotProfile, rate: int) -> "Window":
    try:
        from home_service_gym.window import Window
    except ImportError as error:
        raise SettingsError(
            f"render_mode human needs the cockpit: ./scripts/setup.sh --web ({error})"
        ) from None
    return Window(robot, rate)
