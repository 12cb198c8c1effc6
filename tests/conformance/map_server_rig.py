"""map_server and map_saver for cases: ours and the official ones."""

import tempfile
from pathlib import Path
from typing import Any, List, Mapping, Optional

from facts import fact_of
from graph import observe, official_node, our_node

from planar import MapFileError, load_map

OURS = {"server": "map_lite.ros.map_server", "saver": "map_lite.ros.map_saver"}


def run_ours(case: Mapping[str, Any]) -> Any:
    """Return what our node gives; images are read without a node."""
    if case["kind"] != "image":
        return _observed(case, our_node(OURS[case["kind"]]))
    with tempfile.TemporaryDirectory() as folder:
        for name, content in case["files"].items():
            (Path(folder) / name).write_bytes(bytes(content))
        try:
            return load_map(Path(folder) / "map.yaml").cells.ravel().tolist()
        except MapFileError:
            return "refused"


def run_official(case: Mapping[str, Any]) -> Any:
    """Return what the official node gives; it must be installed."""
    command = official_command(case)
    assert command is not None, "the official node is not installed"
    if case["kind"] != "image":
        return _observed(case, command)
    observed = observe("observe_map_server", command, files=case["files"], arguments=["map.yaml"])
    return observed["map"]["data"] if "map" in observed else "refused"


def official_command(case: Mapping[str, Any]) -> Optional[List[str]]:
    """Return the command of the official node; None if it is not installed."""
    return official_node("map_server", "map_saver" if case["kind"] == "saver" else "map_server")


def _observed(case: Mapping[str, Any], command: List[str]) -> Any:
    given = {key: value for key, value in case.items() if key not in ("kind", "fact")}
    observed = observe(f"observe_map_{case['kind']}", command, **given)
    value = fact_of(observed, case["fact"])
    if case["fact"] == "services":
        return [service for service in value if not service.endswith(("_loggers", "_logger_level"))]
    if case["fact"] == "topics":
        return {topic: kind for topic, kind in value.items() if topic != "/rosout"}
    return value
