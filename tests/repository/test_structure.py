"""Imports respect the layers, and folders, classes and functions stay small."""

import ast
import re
from pathlib import Path
from typing import Iterator, Tuple

import extension_counts
import pytest
import structure

ROOT = structure.ROOT
# From the lowest layer up; a package may import packages of lower layers only.
LAYERS = (
    {"planar"},
    {"rospy_transport"},
    {"supervision", "run_report"},
    {"planar_ros"},
    {"sim_bridge", "map_lite", "amcl_lite", "slam_lite", "move_base_lite", "explorer_lite"}
    | {"pick_objects", "add_markers", "follow_me", "teleop_lite", "auto_docking_lite"},
    {"cockpit"},
    {"home_builder"},
    {"evaluation"},
    {"headless_mission"},
    {"service"},
    {"plugin_examples", "turtle_world", "gazebo_ros", "ros_tools", "ament_index_python"}
    | {"turtlebot3_fake", "turtlebot3_gazebo", "turtlebot3_example", "rtabmap_ros", "multirobot_map_merge"},
    {"run_project", "laboratory"},
    {"home_service_gym"},
    {"home_service"},
)
# Lines of the mechanism of extension points, with all checks of contracts and templates.
MOST_EXTENSION_LINES = 2400
LAYER_OF = {package: number for number, layer in enumerate(LAYERS) for package in layer}


def imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""


def imports_of_others() -> Iterator[Tuple[Path, str, str]]:
    """Yield each import between packages: the module, its package, the imported package."""
    for path in structure.modules(ROOT):
        package = path.parts[len(path.parts) - path.parts[::-1].index("src")]
        for name in imports(path):
            other = name.split(".")[0]
            if other != package and other in LAYER_OF:
                yield path.relative_to(ROOT), package, other


def test_every_package_belongs_to_a_layer():
    packages = {path.parent.name for path in ROOT.glob("src/**/src/*/__init__.py")}
    assert packages == set(LAYER_OF)


def test_packages_import_lower_layers_only():
    upward = [
        f"{path}: {other}"
        for path, package, other in imports_of_others()
        if LAYER_OF[other] >= LAYER_OF[package]
    ]
    assert upward == []


def test_yaml_is_parsed_with_bounds():
    unbounded = re.compile(r"yaml\.(safe_|full_|unsafe_)?load(_all)?\(|yaml\.compose\(")
    modules = [path for path in structure.modules(ROOT) if unbounded.search(path.read_text(encoding="utf-8"))]
    assert modules == [], "use planar.config.bounded_yaml.load_yaml"


@pytest.mark.parametrize(
    ("found", "limit"),
    zip(structure.pieces(ROOT), (structure.LONGEST_CLASS, structure.LONGEST_FUNCTION)),
    ids=("classes", "functions"),
)
def test_classes_and_functions_stay_short(found, limit):
    assert [str(piece) for piece in structure.too_long(found, limit)] == []


def test_folders_stay_small():
    full = structure.folders(ROOT).items()
    assert [f"{folder}: {count}" for folder, count in full if count > structure.FULLEST_FOLDER] == []


def test_no_files_import_each_other():
    assert extension_counts.circles(ROOT) == []


def test_one_file_guards_the_plugins_of_all_packages():
    found = extension_counts.counts(ROOT)
    assert found.guard_files == ["src/planar/src/planar/extensions/point.py"]
    assert found.lines[0] <= MOST_EXTENSION_LINES
