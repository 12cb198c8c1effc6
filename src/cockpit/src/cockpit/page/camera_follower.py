"""The camera of every page, moved with the robot."""

from typing import Optional

import numpy as np

from cockpit.page.server import Page

STILL = 0.01


class CameraFollower:
    """Translates each client's camera by the motion of the robot."""

    def __init__(self, page: Page):
        self._page = page
        self._at: Optional[np.ndarray] = None

    def update(self, base_in_fixed: Optional[np.ndarray]) -> None:
        """Follow the robot.

        Args:
            base_in_fixed: Pose (4, 4) of its base in the fixed frame; None stops following.
        """
        if base_in_fixed is None:
            self._at = None
            return
        at = base_in_fixed[:3, 3]
        if self._at is None:
            self._at = at
            for client in self._page.clients():
                client.camera.position = at + (-2.2, -2.2, 2.6)
                client.camera.look_at = at
        elif np.abs(at - self._at).max() > STILL:
            for client in self._page.clients():
                # The setter translates look_at as well.
                client.camera.position = client.camera.position + (at - self._at)
            self._at = at
