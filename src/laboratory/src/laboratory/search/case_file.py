"""A case as a scenario's file."""

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
from sim_bridge.faults import Fault


def scenario_text(base: Scenario, case: Case, about: str, folder: Path) -> str:
    """The base's file with nothing happening but the case, to lie in ``folder``."""
    told: Dict[str, Any] = yaml.safe_load(base.file.read_text(encoding="utf-8"))
    told["about"] = about
    for part in ("world", "task"):
        told[part] = _relative_paths(folder, base.file.parent, told[part])
    told["happens"] = happens_of(case)
    if case.of(NoiseProfile):
        told["simulation"] = {**(told.get("simulation") or {}), "noise": case.of(NoiseProfile)[0].name}
    if base.planner:
        told["planner"] = {**(told.get("planner") or {}), "name": base.planner}
    told["seeds"] = str(case.seed)
    if not told["happens"]:
        del told["happens"]
    return yaml.safe_dump(told, sort_keys=False, allow_unicode=True, width=110)


def write_case(base: Scenario, case: Case, result: RunResult, folder: Path) -> Path:
    """Writes it into ``folder``, named after what it is; returns the file."""
    about = f"Found by falsify.sh in {base.name}: {result.outcome}, {result.reason}"
    told = scenario_text(base, case, about, folder.resolve())
    path = folder / f"{base.name}_{result.outcome}_{hashlib.sha256(told.encode()).hexdigest()[:6]}.yaml"
    write_atomically(path, told.encode("utf-8"))
    return path


def happens_of(case: Case) -> Dict[str, Any]:
    """As the key ``happens`` has it."""
    boxes = [{"x": box.x, "y": box.y, "yaw": box.yaw} for box in case.of(Pose2)]
    people = [
        {"goals": [list(goal) for goal in walk.goals], "speed": walk.speed}
        for walk in case.of(PedestrianRoute)
    ]
    faults = [
        {"kind": fault.kind, "start": fault.start, "end": fault.end, "strength": fault.strength}
        for fault in case.of(Fault)
    ]
    return {key: rows for key, rows in (("boxes", boxes), ("people", people), ("faults", faults)) if rows}


def _relative_paths(folder: Path, before: Path, table: Any) -> Any:
    """The same with names of files that lie beside another file."""
    if not isinstance(table, dict):
        return table
    return {
        key: os.path.relpath(before / value, folder)
        if isinstance(value, str) and (before / value).exists()
        else value
        for key, value in table.items()
    }
