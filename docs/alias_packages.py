"""Catkin packages that hold official names only, from the table src/compat/packages.yaml.

The table has the description, the dependencies and the nodes of each; the launch files and other data lie
in the package's folder, from which the install rules follow.
"""

from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Tuple

import yaml

REPLACING = "; replaces the official package where it is not installed."
TOOL = "The cockpit's tool of this name, for systems that lack the official package."
TOOL_FUNCTION = "cockpit.ros.rqt:main"
PACKAGE_XML = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>{version}</version>
  <description>{description}</description>
  <maintainer email="maintainers@home-service-robot.example">Home Service Robot maintainers</maintainer>
  <license>BSD-3-Clause</license>

{depends}
</package>
"""
NODE = """#!/usr/bin/env python3
from planar_ros.node.entry import {entry}

{entry}("{function}")
"""
CMAKE_LISTS = """# Made by docs/generate.py from src/compat/packages.yaml; do not edit.
cmake_minimum_required(VERSION 3.0.2)
project({name})

find_package(catkin REQUIRED)
catkin_package()
"""
TOOL_CMAKE_LISTS = """# Made by docs/generate.py from src/compat/packages.yaml; do not edit.
cmake_minimum_required(VERSION 3.0.2)
project({name} NONE)

# Nothing to build; without catkin_package() the first build is 0.25 s faster.
catkin_install_python(PROGRAMS nodes/{name} DESTINATION lib/{name})
"""


def alias_packages(folder: Path, version: str) -> Dict[Path, str]:
    """Return the files of the packages of the table with their texts.

    Args:
        folder: Folder of the packages and of the table.
        version: Version in package.xml.
    """
    files: Dict[Path, str] = {}
    table = yaml.safe_load((folder / "packages.yaml").read_text("utf-8"))
    for name in table["tools"]:
        depends = _depends([("exec_depend", "cockpit")])
        files[folder / name / "package.xml"] = PACKAGE_XML.format(
            name=name, version=version, description=TOOL, depends=depends
        )
        files[folder / name / "CMakeLists.txt"] = TOOL_CMAKE_LISTS.format(name=name)
        files[folder / name / "nodes" / name] = NODE.format(entry="call", function=TOOL_FUNCTION)
    for name, package in table["packages"].items():
        files.update(_package(folder / name, version, package))
    return files


def _package(folder: Path, version: str, package: Mapping[str, Any]) -> Iterator[Tuple[Path, str]]:
    """Yield the files of a package: path, text."""
    depends = [("exec_depend", name) for name in package.get("depends", ())]
    yield (
        folder / "package.xml",
        PACKAGE_XML.format(
            name=folder.name,
            version=version,
            description=package["description"] + REPLACING,
            depends=_depends([("buildtool_depend", "catkin"), *depends]),
        ),
    )
    nodes = {**package.get("nodes", {}), **package.get("forked_nodes", {})}
    for name, function in nodes.items():
        entry = "start_node" if name in package.get("forked_nodes", ()) else "call"
        yield folder / "nodes" / name, NODE.format(entry=entry, function=function)
    rules = "\n".join(_rules(folder, list(nodes)))
    yield folder / "CMakeLists.txt", CMAKE_LISTS.format(name=folder.name) + (f"\n{rules}\n" if rules else "")


def _rules(folder: Path, nodes: List[str]) -> Iterator[str]:
    """Yield the install rules that follow from the content of a package's folder."""
    for path in sorted(folder.glob("env-hooks/*.sh*")):
        hook = path.name.partition(".sh")[0]
        directory = "${CMAKE_CURRENT_SOURCE_DIR}/env-hooks"
        yield f"catkin_add_env_hooks({hook} SHELLS sh DIRECTORY {directory})"
    programs = sorted({*nodes, *(path.name for path in folder.glob("nodes/*") if path.is_file())})
    if programs:
        paths = " ".join(f"nodes/{name}" for name in programs)
        yield f"catkin_install_python(PROGRAMS {paths} DESTINATION ${{CATKIN_PACKAGE_BIN_DESTINATION}})"
    data = [path.name for path in sorted(folder.glob("[a-z]*")) if path.is_dir()]
    data = [name for name in data if name not in ("env-hooks", "nodes")]
    if data:
        yield f"install(DIRECTORY {' '.join(data)} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})"


def _depends(pairs: List[Tuple[str, str]]) -> str:
    return "\n".join(f"  <{kind}>{name}</{kind}>" for kind, name in pairs)
