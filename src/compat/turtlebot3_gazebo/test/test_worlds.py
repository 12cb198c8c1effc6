import re
from pathlib import Path

import pytest

from planar import Pose2
from sim_bridge import ROBOTS, Simulation, load_world

PACKAGE = Path(__file__).resolve().parents[1]
LAUNCHES = [
    path for path in sorted((PACKAGE / "launch").glob("*.launch")) if "spawn_model" in path.read_text()
]


def starts(text):
    """Start poses of the robots in a launch file, from the defaults of its arguments."""
    defaults = dict(re.findall(r'name="(\w+)" default="([^"]*)"', text))
    names = [name[: -len("x_pos")] for name in defaults if name.endswith("x_pos")]
    return [Pose2(float(defaults[f"{name}x_pos"]), float(defaults[f"{name}y_pos"])) for name in names]


@pytest.mark.parametrize("launch", LAUNCHES, ids=lambda path: path.stem)
@pytest.mark.parametrize("robot", ["turtlebot3_burger", "turtlebot3_waffle"])
def test_every_world_loads_without_warnings_and_its_robots_start_free_of_contact(launch, robot):
    text = launch.read_text()
    (name,) = re.findall(r"worlds/(\w+\.world)", text)
    world = load_world(PACKAGE / "worlds" / name, [PACKAGE / "models"])
    assert world.warnings == ()
    first, *others = starts(text)
    simulation = Simulation(world, ROBOTS[robot], base_in_world=first)
    for number, start in enumerate(others):
        assert simulation.scene.add_robot(f"other_{number}", ROBOTS[robot], start) == ()
    assert simulation.step().base_in_world.distance_to(first) < 0.01


def test_the_hall_has_the_official_dimensions():
    world = load_world(PACKAGE / "worlds/turtlebot3_world.world", [PACKAGE / "models"])
    simulation = Simulation(world, ROBOTS["turtlebot3_burger"], base_in_world=Pose2(-2.0, -0.5))
    scan = simulation.step().scan
    while scan is None:
        scan = simulation.step().scan
    # From the lidar, 3.2 cm behind the middle: the pillar at (-1.1, 0), 15 cm in radius, ahead to the left.
    bearing = round(len(scan.ranges) * 0.0797)
    assert min(scan.ranges[bearing - 8 : bearing + 8]) == pytest.approx(0.912, abs=0.05)
