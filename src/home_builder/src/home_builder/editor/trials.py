"""Runs of the home that is edited: its mission in one process, and its robot in the browser."""

import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Dict, Optional

from cockpit.errors import CockpitError
from cockpit.page_program import PageProgram
from home_builder.errors import EditorError

MISSION = ("-m", "home_service", "rehearse", "--home")
ROBOT = ("-m", "home_service", "home_service", "--serve", "--web", "--home")
MISSION_SECONDS, END_SECONDS = 300.0, 20.0


class HomeTrials:
    """Runs the mission of a home, and a graph with a robot in it. Methods may be called from several threads.

    Args:
        folder: Folder of the home, which is built.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._lock = threading.Lock()
        self._mission: Optional[subprocess.Popen] = None
        self._robot: Optional[PageProgram] = None
        # Programs end with the thread that has started them, and those of requests end at once.
        self._starter = ThreadPoolExecutor(1)

    def run_mission(self) -> Dict[str, Any]:
        """Run the mission in one process.

        Returns:
            The verdict as text, and whether it is a success.

        Raises:
            EditorError: It runs already.
        """
        with self._lock:
            if self._mission is not None:
                raise EditorError("the mission runs already")
            self._mission = mission = subprocess.Popen(
                [sys.executable, *MISSION, str(self._folder)],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
        try:
            output, _ = mission.communicate(timeout=MISSION_SECONDS)
        except subprocess.TimeoutExpired:
            mission.kill()
            output = f"not done within {MISSION_SECONDS:g} s"
        finally:
            with self._lock:
                self._mission = None
        return {"success": mission.returncode == 0, "text": output.strip()}

    def drive(self) -> Dict[str, Any]:
        """Start the nodes with the robot in the home, instead of those started before.

        Returns:
            The URL of the cockpit, in which the robot is driven by hand and by missions.

        Raises:
            EditorError: They do not start.
        """
        with self._lock:
            self._end_robot()
            try:
                self._robot = self._starter.submit(
                    PageProgram,
                    [sys.executable, *ROBOT, str(self._folder)],
                    "cockpit",
                    ending=signal.SIGINT,
                ).result()
                return {"url": self._robot.wait_for_url()}
            except CockpitError as error:
                self._robot = None
                raise EditorError(f"the robot does not start: {error}") from None

    def close(self) -> None:
        """End what runs."""
        with self._lock:
            if self._mission is not None:
                self._mission.kill()
            self._end_robot()
        self._starter.shutdown()

    def _end_robot(self) -> None:
        if self._robot is not None:
            self._robot.close(END_SECONDS)
            self._robot = None
