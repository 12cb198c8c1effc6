"""Worlds of homes are read by the official parser of SDF, libsdformat, without errors or warnings."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from home_builder import FurniturePiece, HomePlan, Opening, Wall, build_home
from home_builder.imports import import_plan
from home_builder.palette import KINDS, OUTLINE

MAP = Path(__file__).resolve().parents[3] / "map"
WALLS = (
    Wall((0.0, 0.0), (30.0, 0.0), openings=(Opening("window", 2.0, 1.2, 0.9, 2.1),)),
    Wall((5.0, 0.0), (5.0, 6.0), openings=(Opening("door", 2.0),)),
)
PIECES = tuple(
    FurniturePiece(kind, 7.0 + 2.5 * number, 3.0, 0.3, KINDS[kind].size) for number, kind in enumerate(KINDS)
)
CORNER = FurniturePiece(
    OUTLINE, 2.0, 4.0, 0.0, (2.0, 2.0, 0.8), corners=((-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1))
)
# Models that Gazebo has, which the parser does not find without it.
INCLUDED = re.compile(r"<include>.*?</include>", re.DOTALL)
CHECKER = r"""
#include <iostream>
#include <sdf/Root.hh>
#include <sdf/World.hh>
int main(int, char **arguments) {
  sdf::Root root;
  for (const auto &error : root.Load(arguments[1])) std::cout << error << std::endl;
  const auto *world = root.WorldByIndex(0);
  std::cout << "models " << (world == nullptr ? 0 : world->ModelCount()) << std::endl;
}
"""


@pytest.fixture(scope="module")
def check(tmp_path_factory):
    """Return a function that returns the output of the official parser for a world."""
    if shutil.which("g++") is None or shutil.which("pkg-config") is None:
        pytest.skip("no C++ compiler")
    listed = subprocess.run(["pkg-config", "--list-all"], capture_output=True, text=True).stdout
    found = re.search(r"^sdformat\d*(?=\s)", listed, re.MULTILINE)
    if found is None:
        pytest.skip("libsdformat-dev is not installed")
    flags = subprocess.run(
        ["pkg-config", "--cflags", "--libs", found.group()], capture_output=True, text=True, check=True
    )
    folder = tmp_path_factory.mktemp("checker")
    (folder / "checker.cpp").write_text(CHECKER)
    command = ["g++", "-std=c++17", "checker.cpp", "-o", "checker", *flags.stdout.split()]
    subprocess.run(command, cwd=folder, check=True)

    def output_for(world: Path) -> str:
        plain = folder / "plain.world"
        plain.write_text(INCLUDED.sub("", world.read_text()))
        command = [str(folder / "checker"), str(plain)]
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout

    return output_for


def test_the_official_parser_reads_all_kinds_of_furniture(check, tmp_path):
    build_home(
        HomePlan("a & b", WALLS, (*PIECES, CORNER), start=(2.0, 2.0), start_yaw=1.0), tmp_path / "home"
    )
    assert check(tmp_path / "home/home.world") == f"models {len(PIECES) + 2}\n"


def test_the_official_parser_reads_imported_homes(check, tmp_path):
    plan = import_plan(MAP / "home.yaml")
    build_home(plan, tmp_path / "home")
    assert check(tmp_path / "home/home.world") == f"models {len(plan.furniture) + 1}\n"


def test_errors_of_the_official_parser_are_seen(check, tmp_path):
    (tmp_path / "broken.world").write_text("<sdf version='1.6'><world name='w'><model/></world></sdf>")
    assert "Error" in check(tmp_path / "broken.world")
