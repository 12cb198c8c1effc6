"""One plan that is edited: saved with every change, checked, built, and tried."""

import json
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any, Dict, List, Optional

from home_builder.errors import EditorError
from home_builder.folder import build_home
from home_builder.palette import KINDS
from home_builder.plan.checks import problems_of
from home_builder.plan.file import load_plan, parse_plan, plan_entries, plan_text
from home_builder.plan.geometry import corners_of, room_faces
from home_builder.plan.model import HomePlan
from planar import write_atomically
from planar.errors import FileWriteError
from planar.maps.home_folder import PLAN

# The mission that is tried, in one process, and the time that it may take [s].
TRIAL = ("-m", "home_service", "rehearse", "--home")
TRIAL_SECONDS = 300.0


class EditorSession:
    """The plan of a home's folder while it is edited. Its methods may be called from several threads.

    Args:
        folder: Folder of the home; it is created.
        plan: HomePlan to begin with; None: that of the folder, or an empty one.

    Raises:
        PlanarError: The plan of the folder cannot be read, or nothing can be written there.
    """

    def __init__(self, folder: Path, plan: Optional[HomePlan] = None):
        self.folder = folder
        self._lock = threading.Lock()
        self._trial: Optional[subprocess.Popen] = None
        if plan is None:
            plan = load_plan(folder / PLAN) if (folder / PLAN).is_file() else HomePlan(folder.name)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileWriteError(f"{folder}: cannot be made ({error.strerror})") from None
        self._plan = plan
        self._save()

    def state(self) -> Dict[str, Any]:
        """Return the plan with its problems, rooms and the palette, for JSON."""
        with self._lock:
            palette = {name: list(kind.size) for name, kind in KINDS.items()}
            return {
                "plan": plan_entries(self._plan),
                "palette": palette,
                "folder": str(self.folder),
                **_judged(self._plan),
            }

    def change(self, content: str) -> Dict[str, Any]:
        """Replace the plan and save it.

        Args:
            content: The plan as JSON.

        Returns:
            Its problems and rooms.

        Raises:
            PlanarError: The text is no plan, or it cannot be saved; the last plan is kept.
        """
        plan = parse_plan(content, "drawing")
        with self._lock:
            self._plan = plan
            self._save()
            return _judged(plan)

    def build(self) -> Dict[str, Any]:
        """Build the home. Raises PlanarError."""
        with self._lock:
            return {"remarks": build_home(self._plan, self.folder)}

    def try_out(self) -> Dict[str, Any]:
        """Build the home and run its mission in one process.

        Returns:
            The verdict as text, and whether it is a success.

        Raises:
            PlanarError: The home cannot be built, or a mission runs already.
        """
        self.build()
        with self._lock:
            if self._trial is not None:
                raise EditorError("the mission runs already")
            self._trial = trial = subprocess.Popen(
                [sys.executable, *TRIAL, str(self.folder)],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
        try:
            output, _ = trial.communicate(timeout=TRIAL_SECONDS)
        except subprocess.TimeoutExpired:
            trial.kill()
            output = f"not done within {TRIAL_SECONDS:g} s"
        finally:
            with self._lock:
                self._trial = None
        return {"success": trial.returncode == 0, "text": output.strip()}

    def close(self) -> None:
        """End a mission that runs."""
        with self._lock:
            if self._trial is not None:
                self._trial.kill()

    def _save(self) -> None:
        write_atomically(self.folder / PLAN, plan_text(self._plan).encode("utf-8"))


def _judged(plan: HomePlan) -> Dict[str, Any]:
    problems: List[Dict[str, Any]] = [
        {"text": each.text, "x": each.x, "y": each.y, "is_error": each.is_error} for each in problems_of(plan)
    ]
    rooms = [
        {
            "name": face.name,
            "area": round(face.polygon.area, 2),
            "corners": corners_of(face.polygon).tolist(),
            "middle": list(face.polygon.representative_point().coords[0]),
        }
        for face in room_faces(plan)
    ]
    return {"problems": problems, "rooms": rooms}


def as_json(content: Dict[str, Any]) -> bytes:
    """Return content as JSON; infinite numbers do not occur in plans."""
    return json.dumps(content, allow_nan=False).encode("utf-8")
