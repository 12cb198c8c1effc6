import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict

from home_service.options import ROOT
from supervision.command_line import argument, option

TEMPLATES = ROOT / "src/home_service/templates"
KINDS = tuple(sorted(path.stem for path in TEMPLATES.glob("*.py")))
PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")
# How each kind is chosen, for people.
CHOSEN = {
    "local_planner": "--planner {plugin}, or base_local_planner: {plugin}",
    "global_planner": "base_global_planner: {plugin}",
    "recovery_behavior": "recovery_behaviors: [{{name: mine, type: {plugin}}}]",
    "costmap_layer": "local_costmap/plugins: [..., {{name: mine, type: {plugin}}}]",
}
PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>0.1.0</version>
  <description>{title}: a plugin for move_base_lite.</description>
  <maintainer email="you@example.com">you</maintainer>
  <license>BSD-3-Clause</license>

  <buildtool_depend>catkin</buildtool_depend>
  <buildtool_depend>python3-setuptools</buildtool_depend>
  <exec_depend>move_base_lite</exec_depend>
  <exec_depend>planar</exec_depend>
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

from move_base_lite.check import KITS

KIT = KITS["{kind}"]


@pytest.mark.parametrize("check", KIT.checks, ids=lambda check: check.__name__)
def test_it_keeps_its_contract(check):
    check(KIT.registry.find("{plugin}"))
'''


@dataclass(frozen=True)
class NewPlugin:
    """Lays out a catkin package with a planner, a recovery behaviour or a costmap layer of your own."""

    name: str = argument("of the package, as my_planner", metavar="NAME")
    kind: str = argument("what it is to be", choices=KINDS, metavar="KIND")
    source: Path = option(ROOT / "src", "where packages are", type=Path)

    def run(self) -> int:
        from planar import SettingsError, write_atomically

        folder = self.source / self.name
        if not PACKAGE_NAME.fullmatch(self.name):
            raise SettingsError(
                f"{self.name} is no name of a package: lower case, digits and _, as my_planner"
            )
        if folder.exists():
            raise SettingsError(f"{folder} is there already")
        for path, text in self._texts().items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            write_atomically(folder / path, text.encode())
        print(f"{folder}/src/{self.name}/{self.kind}.py is yours to write; then")
        print(f"  ./scripts/test.sh unit {self.name}")
        print(f"  {CHOSEN[self.kind].format(plugin=self._plugin)}")
        return 0

    @property
    def _class(self) -> str:
        return "".join(word.capitalize() for word in self.name.split("_"))

    @property
    def _plugin(self) -> str:
        return f"{self.name}.{self.kind}/{self._class}"

    def _texts(self) -> Dict[str, str]:
        """All files of the package."""
        title = self.name.replace("_", " ").capitalize()
        words = {"package": self.name, "title": title, "kind": self.kind, "plugin": self._plugin}
        code = (TEMPLATES / f"{self.kind}.py").read_text(encoding="utf-8")
        return {
            "package.xml": PACKAGE_XML.format(**words),
            "CMakeLists.txt": CMAKE_LISTS.format(**words),
            "setup.py": SETUP,
            f"src/{self.name}/__init__.py": f'"""{title}."""\n',
            f"src/{self.name}/{self.kind}.py": code.replace("TITLE", title).replace("CLASS", self._class),
            f"test/test_{self.name}.py": TEST.format(**words),
        }
