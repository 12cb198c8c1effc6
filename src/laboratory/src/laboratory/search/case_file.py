"""Scenario files of cases."""

import hashlib
import os
from pathlib import Path
from typing import Any, Dict

import yaml

from laboratory.results.result import RunResult
from laboratory.scenario.scenario import Scenario
from laboratory.search.cases import Case, NoiseProfile
from laboratory.worlds.people import PedestrianRoute
from planar import Pose2, write_atomically
from planar.config.bounded_yaml import load_yaml
from sim_bridge.faults import Fault


def scenario_text(base: Scenario, case: Case, about: str, folder: Path) -> str:
    """Return the text of a scenario file in ``folder``: the base scenario with this case."""
    content: Dict[str, Any] = load_yaml(base.file.read_text(encoding="utf-8"))
    content["about"] = about
    for part in ("world", "task"):
        content[part] = _relative_paths(folder, base.file.parent, content[part])
    content["happens"] = happens_of(case)
    if case.of(NoiseProfile):
        content["simulation"] = {**(content.get("simulation") or {}), "noise": case.of(NoiseProfile)[0].name}
    if base.planner:
        content["planner"] = {**(content.get("planner") or {}), "name": base.planner}
    content["seeds"] = str(case.seed)
    if not content["happens"]:
        del content["happens"]
    return yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110)


def write_case(base: Scenario, case: Case, result: RunResult, folder: Path) -> Path:
    """Write the scenario file of a case into ``folder``; return its path."""
    about = f"Found by falsify.sh in {base.name}: {result.outcome}, {result.reason}"
    text = scenario_text(base, case, about, folder.resolve())
    path = folder / f"{base.name}_{result.outcome}_{hashlib.sha256(text.encode()).hexdigest()[:6]}.yaml"
    write_atomically(path, text.encode("utf-8"))
    return path


def happens_of(case: Case) -> Dict[str, Any]:
    """Return the disturbances of a case as the table ``happens``."""
    boxes = [{"x": box.x, "y": box.y, "yaw": box.yaw} for box in case.of(Pose2)]
    people = [
        {"goals": [list(goal) for goal in route.goals], "speed": route.speed}
        for route in case.of(PedestrianRoute)
    ]
    faults = [
        {"kind": fault.kind, "start": fault.start, "end": fault.end, "strength": fault.strength}
        for fault in case.of(Fault)
    ]
    return {key: rows for key, rows in (("boxes", boxes), ("people", people), ("faults", faults)) if rows}


def _relative_paths(folder: Path, before: Path, table: Any) -> Any:
    """Make paths relative to ``before`` relative to ``folder``."""
    if not isinstance(table, dict):
        return table
    return {
        key: os.path.relpath(before / value, folder)
        if isinstance(value, str) and (before / value).exists()
        else value
        for key, value in table.items()
    }
