"""One loop steps simulations, sim_bridge.Episode; every other caller of ``step`` has a reason."""

import ast
from pathlib import Path
from typing import Iterator, Tuple

import structure

ROOT = structure.ROOT
# Names by which simulations and scenes are held.
HOLDERS = {"simulation", "_simulation", "scene", "_scene"}
ALLOWED = {
    "src/sim_bridge/src/sim_bridge/episode.py": "the loop",
    "src/sim_bridge/src/sim_bridge/simulation.py": "one robot of a scene",
    "src/sim_bridge/src/sim_bridge/ros/robot_manager.py": "the node, in time with its graph",
    "src/home_service_gym/src/home_service_gym/environment.py": "Gymnasium steps EpisodeSimulation",
    "src/home_service_gym/src/home_service_gym/turtlebot3_stage.py": "Gymnasium steps EpisodeSimulation",
}


def callers_of_step(path: Path) -> Iterator[int]:
    """Yield the lines that call ``step`` of a simulation or of a scene."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "step":
            holder = node.func.value
            name = getattr(holder, "attr", getattr(holder, "id", ""))
            called = getattr(getattr(holder, "func", None), "id", "")
            if name in HOLDERS or called in ("Simulation", "Scene"):
                yield node.lineno


def found() -> Iterator[Tuple[str, int]]:
    for path in (*structure.modules(ROOT), *sorted((ROOT / "tests/benchmarks").rglob("*.py"))):
        for line in callers_of_step(path):
            yield path.relative_to(ROOT).as_posix(), line


def test_only_the_episode_steps_simulations():
    others = [f"{path}:{line}" for path, line in found() if path not in ALLOWED]
    assert others == []


def test_every_exception_is_needed():
    assert {path for path, _ in found()} == set(ALLOWED)


def test_a_call_is_found_by_the_name_of_its_holder(tmp_path):
    (tmp_path / "loop.py").write_text(
        "self._simulation.step(command)\nSimulation(world).step()\nenv.step(action)\n"
    )
    assert list(callers_of_step(tmp_path / "loop.py")) == [1, 2]


if __name__ == "__main__":
    for path, line in found():
        print(f"{path}:{line}: {ALLOWED.get(path, 'NOT ALLOWED')}")
