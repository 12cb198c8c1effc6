"""The house stands: every import leads down a storey, and nothing outgrows the eye."""

import ast
from pathlib import Path
from typing import Iterator, Tuple

import pytest
import structure

ROOT = structure.ROOT
# From the ground up; a package may import those on storeys below it. turtle_world is built out of two others.
STOREYS = (
    {"planar"},
    {"supervision", "run_report"},
    {"planar_ros"},
    {"sim_bridge", "map_lite", "amcl_lite", "slam_lite", "move_base_lite", "explorer_lite"}
    | {"pick_objects", "add_markers", "follow_me", "teleop_lite"},
    {"cockpit"},
    {"home_service", "plugin_examples", "turtle_world", "gazebo_ros", "ros_tools", "ament_index_python"}
    | {"turtlebot3_fake", "turtlebot3_gazebo", "turtlebot3_example", "rtabmap_ros", "multirobot_map_merge"},
    {"run_project", "laboratory"},
    {"home_service_gym"},
)
STOREY_OF = {package: number for number, storey in enumerate(STOREYS) for package in storey}


def imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""


def imports_of_others() -> Iterator[Tuple[Path, str, str]]:
    """Each import of one package of the house by another: the module, its package, the other."""
    for path in structure.modules(ROOT):
        package = path.parts[len(path.parts) - path.parts[::-1].index("src")]
        for name in imports(path):
            other = name.split(".")[0]
            if other != package and other in STOREY_OF:
                yield path.relative_to(ROOT), package, other


def test_every_package_stands_on_a_storey():
    packages = {path.parent.name for path in ROOT.glob("src/**/src/*/__init__.py")}
    assert packages == set(STOREY_OF)


def test_imports_lead_down():
    climbing = [
        f"{path}: {other}"
        for path, package, other in imports_of_others()
        if STOREY_OF[other] >= STOREY_OF[package]
    ]
    assert climbing == []


@pytest.mark.parametrize(
    ("found", "limit"),
    zip(structure.pieces(ROOT), (structure.LONGEST_CLASS, structure.LONGEST_FUNCTION)),
    ids=("classes", "functions"),
)
def test_what_a_person_reads_at_once_stays_short(found, limit):
    assert [str(piece) for piece in structure.too_long(found, limit)] == []


def test_a_folder_holds_no_more_modules_than_a_person_can_name():
    full = structure.folders(ROOT).items()
    assert [f"{folder}: {count}" for folder, count in full if count > structure.FULLEST_FOLDER] == []
