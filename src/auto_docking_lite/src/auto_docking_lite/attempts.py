"""States and attempts of a task that is tried several times before it fails."""

from typing import Dict, Optional

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import DockCode, DockInputs, DockResult, DockState
from planar import Twist2

STOP = Twist2()


class RetriedTask:
    """Base class of a task with states and attempts; its methods return the command of the tick.

    Args:
        settings: Number of retries and time-outs.

    Attributes:
        state: Present state.
    """

    def __init__(self, settings: DockingSettings):
        self._settings = settings
        self.state = DockState.IDLE
        self._text, self._attempt = "", 0
        self._result: Optional[DockResult] = None
        # Since when conditions hold, by name; all but "charging" end with the state.
        self._since: Dict[str, float] = {}

    def _enter(self, state: DockState, text: str) -> Twist2:
        """Change the state."""
        self.state, self._text = state, text
        self._since = {name: at for name, at in self._since.items() if name == "charging"}
        return STOP

    def _wait(self, inputs: DockInputs, code: DockCode, text: str) -> Twist2:
        """Stand still while something is in the way, for some time."""
        self._text = text
        waited = inputs.stamp - self._since.setdefault("blocked", inputs.stamp)
        return self._retry(code, text) if waited > self._settings.blocked_timeout else STOP

    def _retry(self, code: DockCode, text: str, state: DockState = DockState.BUMPED) -> Twist2:
        """Try once more from another side, or fail."""
        self._attempt += 1
        if self._attempt > self._settings.max_retries:
            return self._fail(code, text)
        return self._enter(state, f"{text}; attempt {self._attempt + 1}")

    def _fail(self, code: DockCode, text: str) -> Twist2:
        """End the task with a failure."""
        attempts = f" ({self._attempt} attempts)" if self._attempt > 1 else ""
        self._result = DockResult(code, f"Aborted: {code.name} ({int(code)}): {text}{attempts}.")
        self.state = DockState.IDLE
        return STOP
