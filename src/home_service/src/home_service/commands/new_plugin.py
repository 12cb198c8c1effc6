import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict

from evaluation.options import ROOT
from supervision.command_line import argument, option

TEMPLATES = ROOT / "src/home_service/templates"
EXAMPLES = ROOT / "src/plugin_examples"
PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")


@dataclass(frozen=True)
class PluginKind:
    """A kind of plugin.

    Attributes:
        user: Package that uses it.
        chosen: How it is selected there, for people.
        example: Module and class of plugin_examples with which a new one begins; empty: the template.
    """

    user: str
    chosen: str
    example: str = ""


KINDS = {
    "local_planner": PluginKind(
        "move_base_lite", "--planner {plugin}, or base_local_planner: {plugin}", "pure_pursuit/PurePursuit"
    ),
    "global_planner": PluginKind("move_base_lite", "base_global_planner: {plugin}", "rrt_star/RrtStar"),
    "recovery_behavior": PluginKind("move_base_lite", "recovery_behaviors: [{{name: mine, type: {plugin}}}]"),
    "costmap_layer": PluginKind(
        "move_base_lite",
        "local_costmap/plugins: [..., {{name: mine, type: {plugin}}}]",
        "social_distance/SocialDistance",
    ),
    "sensor_model": PluginKind("amcl_lite", "sensor_plugin: {plugin}", "short_readings/ShortReadings"),
    "motion_model": PluginKind("amcl_lite", "motion_plugin: {plugin}"),
    "scan_matcher": PluginKind("slam_lite", "matcher_plugin: {plugin}", "closest_points/ClosestPoints"),
    "fault": PluginKind("sim_bridge", "faults: [{{kind: {plugin}, start: 8.0}}] in a mission or a scenario"),
    "world_generator": PluginKind("laboratory", "world: {{{plugin}: {{}}}} in a scenario"),
}
PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>0.1.0</version>
  <description>{title}: a plugin for {user}.</description>
  <maintainer email="you@example.com">you</maintainer>
  <license>BSD-3-Clause</license>

  <buildtool_depend>catkin</buildtool_depend>
  <buildtool_depend>python3-setuptools</buildtool_depend>
  <exec_depend>{user}</exec_depend>
  <exec_depend>planar</exec_depend>
</package>
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
        kind, title = KINDS[self.kind], self.name.replace("_", " ").capitalize()
        words = {
            "package": self.name,
            "title": title,
            "kind": self.kind,
            "plugin": self._plugin,
            "user": kind.user,
        }
        module, _, named = kind.example.rpartition("/")
        source = (
            EXAMPLES / "src/plugin_examples" / f"{module}.py" if module else TEMPLATES / f"{self.kind}.py"
        )
        code = source.read_text(encoding="utf-8").replace(named or "CLASS", self._class)
        return {
            "package.xml": PACKAGE_XML.format(**words),
            "CMakeLists.txt": _of_examples("CMakeLists.txt").replace("plugin_examples", self.name),
            "setup.py": _of_examples("setup.py"),
            f"src/{self.name}/__init__.py": f'"""{title}."""\n',
            f"src/{self.name}/{self.kind}.py": code.replace("TITLE", title),
            f"test/test_{self.name}.py": TEST.format(**words),
        }


def _of_examples(name: str) -> str:
    return (EXAMPLES / name).read_text(encoding="utf-8")
