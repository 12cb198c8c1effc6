import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict

from evaluation.options import ROOT
from supervision.command_line import argument, option

TEMPLATES = ROOT / "src/home_service/templates"
PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True)
class PluginKind:
    """A kind of plugin.

    Attributes:
        user: Package that uses it.
        chosen: How it is selected there, for people.
    """

    user: str
    chosen: str


KINDS = {
    "local_planner": PluginKind("move_base_lite", "--planner {plugin}, or base_local_planner: {plugin}"),
    "global_planner": PluginKind("move_base_lite", "base_global_planner: {plugin}"),
    "recovery_behavior": PluginKind("move_base_lite", "recovery_behaviors: [{{name: mine, type: {plugin}}}]"),
    "costmap_layer": PluginKind(
        "move_base_lite", "local_costmap/plugins: [..., {{name: mine, type: {plugin}}}]"
    ),
    "sensor_model": PluginKind("amcl_lite", "sensor_plugin: {plugin}"),
    "motion_model": PluginKind("amcl_lite", "motion_plugin: {plugin}"),
    "scan_matcher": PluginKind("slam_lite", "matcher_plugin: {plugin}"),
    "fault": PluginKind("sim_bridge", "faults: [{{kind: {plugin}, start: 8.0}}] in a mission or a scenario"),
    "world_generator": PluginKind("laboratory", "world: {{{plugin}: {{}}}} in a scenario"),
}
# Dependencies of every plugin, beside the package that uses it.
USED = ("planar",)
PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>0.1.0</version>
  <description>{title}: a plugin for {user}.</description>
  <maintainer email="you@example.com">you</maintainer>
  <license>BSD-3-Clause</license>

  <buildtool_depend>catkin</buildtool_depend>
  <buildtool_depend>python3-setuptools</buildtool_depend>
  {depends}
</package>
"""
CMAKE_LISTS = """cmake_minimum_required(VERSION 3.0.2)
project({package})

find_package(catkin REQUIRED)
catkin_python_setup()
catkin_package()
"""
SETUP = """from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

setup(**generate_distutils_setup(packages=find_packages("src"), package_dir={"": "src"}))
"""
TEST = '''"""{title} keeps its contract."""

import pytest

from {user}.check import CHECK_SUITES

SUITE = CHECK_SUITES["{kind}"]


@pytest.mark.parametrize("check", SUITE.checks, ids=lambda check: check.__name__)
def test_it_keeps_its_contract(check):
    check(SUITE.find("{plugin}"))
'''


@dataclass(frozen=True)
class NewPlugin:
    """Create a catkin package in src/ with a plugin class and its test.

    How to write each kind: docs/how_to/write_a_plugin.md.

    Exit code: 0 success, 2 invalid input, 130 interrupted.
    """

    name: str = argument("name of the package, such as my_planner", metavar="NAME")
    kind: str = argument(f"one of {', '.join(KINDS)}", choices=tuple(KINDS), metavar="KIND")
    source: Path = option(ROOT / "src", "folder of the package", type=Path, metavar="FOLDER")

    def run(self) -> int:
        from planar import SettingsError, write_atomically

        folder = self.source / self.name
        if not PACKAGE_NAME.fullmatch(self.name):
            raise SettingsError(
                f"{self.name} is no package name: use lower-case letters, digits and _, as in my_planner"
            )
        if folder.exists():
            raise SettingsError(f"{folder} exists already")
        for path, text in self._texts().items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            write_atomically(folder / path, text.encode())
        print(f"{folder}/src/{self.name}/{self.kind}.py is where to start; then")
        print(f"  ./scripts/test.sh --quick unit {self.name}")
        print(f"  {KINDS[self.kind].chosen.format(plugin=self._plugin)}")
        return 0

    @property
    def _class(self) -> str:
        return "".join(word.capitalize() for word in self.name.split("_"))

    @property
    def _plugin(self) -> str:
        return f"{self.name}.{self.kind}/{self._class}"

    def _texts(self) -> Dict[str, str]:
        """Return the files of the package."""
        title = self.name.replace("_", " ").capitalize()
        user = KINDS[self.kind].user
        words = {
            "package": self.name,
            "title": title,
            "kind": self.kind,
            "plugin": self._plugin,
            "user": user,
            "depends": "\n  ".join(f"<exec_depend>{each}</exec_depend>" for each in sorted({user, *USED})),
        }
        code = (TEMPLATES / f"{self.kind}.py").read_text(encoding="utf-8")
        return {
            "package.xml": PACKAGE_XML.format(**words),
            "CMakeLists.txt": CMAKE_LISTS.format(**words),
            "setup.py": SETUP,
            f"src/{self.name}/__init__.py": f'"""{title}."""\n',
            f"src/{self.name}/{self.kind}.py": code.replace("TITLE", title).replace("CLASS", self._class),
            f"test/test_{self.name}.py": TEST.format(**words),
        }
