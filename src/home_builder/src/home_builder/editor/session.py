"""One plan that is edited: saved with every change, checked, built, and tried."""

import hashlib
import io
import json
import threading
from pathlib import Path
from typing import Any, Dict, List, Optional

from home_builder.editor.template import read_template, remove_unused_templates, save_template, traced
from home_builder.editor.trials import HomeTrials
from home_builder.errors import EditorError
from home_builder.folder import build_home
from home_builder.palette import KINDS
from home_builder.plan.checks import problems_of
from home_builder.plan.file import load_plan, parse_plan, plan_entries, plan_text
from home_builder.plan.geometry import corners_of, room_faces
from home_builder.plan.model import HomePlan
from planar import load_map, write_atomically
from planar.errors import FileWriteError
from planar.maps.home_folder import IMAGE, MAP, PLAN

# File for a drawing that cannot replace the plan, since that was changed elsewhere.
REFUSED = "plan_refused.yaml"


class EditorSession:
    """The plan of a home's folder while it is edited. Its methods may be called from several threads.

    Args:
        folder: Folder of the home; it is created.
        plan: HomePlan to begin with; None: that of the folder, or an empty one.

    Attributes:
        trials: Runs of the home.

    Raises:
        PlanarError: The plan of the folder cannot be read, or nothing can be written there.
    """

    def __init__(self, folder: Path, plan: Optional[HomePlan] = None):
        self.folder, self.trials = folder, HomeTrials(folder)
        self._lock = threading.Lock()
        self._plan: HomePlan
        if plan is None:
            plan = load_plan(folder / PLAN) if (folder / PLAN).is_file() else HomePlan(folder.name)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileWriteError(f"{folder}: cannot be made ({error.strerror})") from None
        self._save(plan)
        remove_unused_templates(folder, plan)

    def state(self) -> Dict[str, Any]:
        """Return the plan with its version, problems, rooms and the palette, for JSON."""
        with self._lock:
            if not (self.folder / PLAN).is_file():
                self._save(self._plan)
            self._plan = load_plan(self.folder / PLAN)
            palette = {name: list(kind.size) for name, kind in KINDS.items()}
            return {
                "plan": plan_entries(self._plan),
                "palette": palette,
                "folder": str(self.folder),
                "version": self._version(),
                **_judged(self._plan),
            }

    def change(self, content: str, version: Optional[str] = None) -> Dict[str, Any]:
        """Replace the plan and save it.

        Args:
            content: The plan as JSON.
            version: Version of the plan that is changed; None: whatever it is.

        Returns:
            Its version, problems and rooms.

        Raises:
            PlanarError: The text is no plan, the file has changed since, or it cannot be saved; the last plan
                is kept.
        """
        plan = parse_plan(content, "drawing")
        with self._lock:
            if version is not None and version != self._version():
                self._write(REFUSED, plan)
                raise EditorError(
                    f"{self.folder / PLAN} was changed elsewhere, in another tab or by hand: reload the page "
                    f"to go on from there; what is drawn here is kept in {self.folder / REFUSED}"
                )
            self._save(plan)
            return {"version": self._version(), **_judged(plan)}

    def build(self) -> Dict[str, Any]:
        """Build the home. Raises PlanarError."""
        with self._lock:
            return {"remarks": build_home(self._plan, self.folder)}

    def try_out(self) -> Dict[str, Any]:
        """Build the home and run its mission.

        Returns:
            The verdict as text, and whether it is a success.

        Raises:
            PlanarError: The home cannot be built, or a mission runs already.
        """
        self.build()
        return self.trials.run_mission()

    def drive(self) -> Dict[str, Any]:
        """Build the home and start the robot in it.

        Returns:
            The URL of its cockpit.

        Raises:
            PlanarError: The home cannot be built, or the robot does not start.
        """
        self.build()
        return self.trials.drive()

    def set_template(self, content: bytes) -> Dict[str, Any]:
        """Save the picture to trace. Returns its entry in the plan. Raises PlanarError."""
        return {"template": vars(save_template(self.folder, content))}

    def template(self, name: str) -> bytes:
        """Return the file of a template. Raises EditorError."""
        return read_template(self.folder, name)

    def trace(self) -> Dict[str, Any]:
        """Return the plan that the template shows, for JSON. Raises PlanarError."""
        with self._lock:
            template = self._plan.template
        if template is None:
            raise EditorError("choose a picture of a floor plan as the template first, and set its scale")
        return {"found": plan_entries(traced(self.folder, template))}

    def map_picture(self) -> bytes:
        """Return the map of the home that was built last, as PNG. Raises PlanarError."""
        from PIL import Image

        load_map(self.folder / MAP)  # states what is wrong with it
        content = io.BytesIO()
        with Image.open(self.folder / IMAGE) as image:
            image.save(content, "PNG")
        return content.getvalue()

    def close(self) -> None:
        """End what runs."""
        self.trials.close()

    def _save(self, plan: HomePlan) -> None:
        self._write(PLAN, plan)
        self._plan = plan

    def _write(self, name: str, plan: HomePlan) -> None:
        write_atomically(self.folder / name, plan_text(plan).encode("utf-8"))

    def _version(self) -> str:
        """Return the hash of the plan's file; empty if it is gone."""
        try:
            return hashlib.sha256((self.folder / PLAN).read_bytes()).hexdigest()
        except OSError:
            return ""


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
