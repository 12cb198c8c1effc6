"""The project's workspace: copied into a work folder, completed, and built on top of this workspace."""

import os
import re
import shutil
import signal
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable, Dict, Set, Tuple

from planar import PlanarError
from run_project.checkout.layout import BUILD_AND_VCS_FOLDERS, Checkout
from run_project.checkout.placement import Placement
from run_project.checkout.substitutes import complete_package, link_substitutes
from run_project.preparation.build_stamp import BuildStamp
from run_project.preparation.python2 import to_python3
from run_project.preparation.selection import select_packages
from run_project.stand_ins import PACKAGE_FOLDER, STAND_INS, is_of_workspace

FRESH_CLONE = PACKAGE_FOLDER / "cmake" / "fresh_clone.cmake"
# Limit of repeated configurations; each excludes the packages that fail to configure.
MAX_CONFIGURATIONS = 20
MODEL_PATH = "GAZEBO_MODEL_PATH"
# Variables that authors set in ~/.bashrc, with the most common value.
DEFAULT_VARIABLES = {"TURTLEBOT3_MODEL": "burger"}
CONFIGURATION_INCOMPLETE = "Configuring incomplete"

# A CMake error, its reason, and the first file of the project in its call stack.
_CMAKE_ERROR = re.compile(r"^CMake Error at ", re.MULTILINE)
_CMAKE_REASON = re.compile(r"\n\s*([^\n]+)")
_CMAKE_PLACE = re.compile(r"(\S+?)/CMakeLists\.txt:\d+")
_ABSENT_TARGET = re.compile(r'The dependency target "(\w+)" of target')
_MISSING_CONFIG = re.compile(r'provided by\s+"(\S+?)"')
_BROKEN_SOURCE = re.compile(r"^(/\S+?):\d+(?::\d+)?: (?:fatal )?error: (.*)", re.MULTILINE)
_BROKEN_LINK = re.compile(r"CMakeFiles/(\S+?)\.dir/\S+: (?:in function .*?: )?(undefined reference .*)")


class BuildError(PlanarError):
    """The packages of the project cannot be built."""


@dataclass
class Workspace:
    """The copy of a project in a catkin workspace. Paths are absolute.

    Attributes:
        folder: Folder of the workspace.
        checkout: Copy of the checkout.
        packages: Package name -> folder.
        placeholders: CMake prefix for empty packages that replace missing dependencies.
        model_folders: Folders with Gazebo models.
        unbuilt: Packages that are not built; only their files are used.
        missing: Package that is excluded, replaced or incomplete -> reason.
        absent_targets: CMake targets that packages depend on and that no package defines.
    """

    folder: Path
    checkout: Path
    packages: Dict[str, Path]
    placeholders: Path
    model_folders: Tuple[Path, ...] = ()
    unbuilt: Set[str] = field(default_factory=set)
    missing: Dict[str, str] = field(default_factory=dict)
    absent_targets: Set[str] = field(default_factory=set)


def copy_checkout(checkout: Checkout, placement: Placement, work: Path) -> Workspace:
    """Copy the project to ``work``/tree.

    Earlier build results and file times are kept, so that only changed files are built again.

    Args:
        checkout: The project.
        placement: Where checkout and workspace go below the tree.
        work: Work folder of the project.
    """
    tree = work / "tree"
    if tree.exists():
        shutil.rmtree(tree)
    target, workspace = tree / placement.checkout, tree / placement.workspace
    shutil.copytree(
        checkout.root,
        target,
        symlinks=True,
        dirs_exist_ok=True,
        ignore=lambda folder, names: {
            name for name in BUILD_AND_VCS_FOLDERS & set(names) if Path(folder, name).is_dir()
        },
    )
    link_substitutes(checkout.substitutes, target)
    for program in checkout.programs():  # often committed without the executable bit
        (target / program).chmod(0o755)
    for missing, found in placement.links.items():
        link = tree / missing
        link.parent.mkdir(parents=True, exist_ok=True)
        if not link.exists():
            link.symlink_to(tree / found)
    for name in ("build", "devel"):
        (work / name).mkdir(exist_ok=True)
        (workspace / name).symlink_to(work / name)
    # Often a link into the author's ROS installation.
    (workspace / "src" / "CMakeLists.txt").unlink(missing_ok=True)
    packages = {name: target / folder for name, folder in checkout.packages.items()}
    model_folders = tuple(target / folder for folder in checkout.model_folders())
    return Workspace(workspace, target, packages, work / "placeholders", model_folders)


def build(workspace: Workspace, log: Path, report: Callable[[str], None]) -> None:
    """Build the workspace; packages that fail are excluded and added to ``workspace.missing``.

    Nothing is built if nothing has changed since the last build, and this was complete.

    Args:
        workspace: The project's copy.
        log: File to which the output of catkin_make is appended.
        report: Called with a line for each excluded or replaced package.

    Raises:
        BuildError: The workspace cannot be configured.
    """
    stand_ins = {folder.name: folder for folder in PACKAGE_FOLDER.parent.iterdir()}
    selection = select_packages(workspace.packages, stand_ins, is_installed)
    work = workspace.placeholders.parent
    stamp = BuildStamp(work / "built", work / "tree", selection.names())
    for name in selection.replaced:
        complete_package(workspace.packages[name], stand_ins[name], name in selection.without_parts)
    workspace.unbuilt.update(selection.replaced)
    workspace.missing.update(selection.replaced)
    _report_packages("programs replaced by those of this workspace:", selection.replaced, report)
    _exclude(workspace, selection.unbuilt, report)
    for name, users in selection.absent.items():
        _create_placeholder(workspace, name)
        report(f"  package {name} is not installed; built without it: {', '.join(users)}")
    _convert_python2(workspace, report)
    if stamp.is_current and (workspace.folder / "devel" / "setup.bash").exists():
        return
    stamp.remove()
    excluded = len(workspace.unbuilt)
    for _ in range(MAX_CONFIGURATIONS):
        output = _catkin_make(workspace, log)
        absent = set(_ABSENT_TARGET.findall(output)) - workspace.absent_targets
        workspace.absent_targets |= absent
        broken = {} if absent else broken_configurations(workspace, output)
        if not (absent or broken):
            break
        _exclude(workspace, broken, report)
    if CONFIGURATION_INCOMPLETE in output or not (workspace.folder / "devel" / "setup.bash").exists():
        raise BuildError(f"the project's workspace cannot be configured; see the errors at the end of {log}")
    if _failed(output):
        output = _catkin_make(
            workspace, log
        )  # undeclared message dependencies: messages may be generated after their users are compiled
    broken = _broken_sources(workspace, output)
    workspace.missing.update(broken)
    _report_packages("not compiled:", broken, report)
    if not (broken or _failed(output)) and len(workspace.unbuilt) == excluded:
        stamp.write()


def environment(workspace: Workspace) -> Dict[str, str]:
    """Environment after sourcing the workspace, with the model folders and default variables added."""
    script = 'source "$1/devel/setup.bash" >&2; exec env -0'
    kept = {name: value for name, value in os.environ.items() if not _may_be_default(name, value)}
    output = subprocess.run(
        ["bash", "-c", script, "bash", str(workspace.folder)], env=kept, stdout=subprocess.PIPE, check=True
    ).stdout
    pairs = (entry.partition("=") for entry in output.decode(errors="surrogateescape").split("\0") if entry)
    variables = {name: value for name, _, value in pairs}
    model_path = [variables.get(MODEL_PATH, ""), *map(str, workspace.model_folders)]
    return {**DEFAULT_VARIABLES, **variables, MODEL_PATH: ":".join(filter(None, model_path))}


def _may_be_default(name: str, value: str) -> bool:
    """Whether this workspace may have set a variable, to a default that must not hide the project's."""
    is_file = name.endswith("_FILE") and not is_of_workspace(value)
    return name.startswith("TURTLEBOT_") and not is_file


def is_installed(package: str) -> bool:
    """Whether catkin finds a package, of this workspace or of the system."""
    folders = (f"share/{package}/cmake", f"lib/cmake/{package}", f"lib/*/cmake/{package}")
    prefixes = [*filter(None, os.environ.get("CMAKE_PREFIX_PATH", "").split(":")), "/usr"]
    return any(any(Path(prefix).glob(folder)) for prefix in prefixes for folder in folders)


def _exclude(workspace: Workspace, reasons: Dict[str, str], report: Callable[[str], None]) -> None:
    workspace.unbuilt.update(reasons)
    workspace.missing.update(reasons)
    _report_packages("not built:", reasons, report)


def _report_packages(what: str, reasons: Dict[str, str], report: Callable[[str], None]) -> None:
    for reason in sorted(set(reasons.values())):
        names = sorted(name for name in reasons if reasons[name] == reason)
        report(f"  {what} {', '.join(names)} ({reason})")


def _create_placeholder(workspace: Workspace, name: str) -> None:
    """Create an empty CMake package: many declared dependencies are needed only at run time, or never."""
    folder = workspace.placeholders / "share" / name / "cmake"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}Config.cmake").write_text(f"set({name}_FOUND_CATKIN_PROJECT TRUE)\n")


def _convert_python2(workspace: Workspace, report: Callable[[str], None]) -> None:
    """Convert Python 2 scripts of the copy to Python 3."""
    changed = []
    for name in sorted(set(workspace.packages) - set(workspace.missing)):
        for script in sorted(workspace.packages[name].rglob("*.py")):
            source = script.read_text(encoding="utf-8", errors="surrogateescape")
            text = to_python3(source)
            if text != source:
                script.write_text(text, encoding="utf-8", errors="surrogateescape")
                changed.append(script.name)
    if changed:
        report(f"  converted from Python 2 to Python 3 in the copy: {', '.join(changed)}")


def _catkin_make(workspace: Workspace, log: Path) -> str:
    """Run catkin_make and return its output; a failed target does not stop the others."""
    command = [
        "catkin_make",
        f"-DCMAKE_PROJECT_INCLUDE={FRESH_CLONE}",
        f"-DABSENT_TARGETS={';'.join(sorted(workspace.absent_targets))}",
        "-DCATKIN_ENABLE_TESTING=OFF",
        f"-DCATKIN_BLACKLIST_PACKAGES={';'.join(sorted(workspace.unbuilt))}",
        "-Wno-dev",
    ]
    # Debian 13's catkin uses the second name.
    command += [f"-D{name}_EXECUTABLE={shutil.which('python3')}" for name in ("PYTHON", "Python")]
    command += ["--force-cmake", "--make-args", "-k"]
    variables = {
        "CMAKE_PREFIX_PATH": f"{STAND_INS}:{os.environ['CMAKE_PREFIX_PATH']}:{workspace.placeholders}",
        "LC_ALL": "C",
        "PWD": str(workspace.folder),  # read by catkin_make
        "ROS_PARALLEL_JOBS": f"-j{os.cpu_count()}",  # the default waits while the load is high
    }
    make = subprocess.Popen(
        command,
        cwd=str(workspace.folder),
        env={**os.environ, **variables},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
        text=True,
        errors="replace",
    )
    try:
        output, _ = make.communicate()
    except BaseException:
        os.killpg(make.pid, signal.SIGKILL)
        make.wait()
        raise
    with log.open("a", encoding="utf-8") as file:
        file.write(output)
    return output


def _failed(output: str) -> bool:
    return bool(re.search(r"^make.*\*\*\*|Invoking .* failed", output, re.MULTILINE))


def broken_configurations(workspace: Workspace, output: str) -> Dict[str, str]:
    if CONFIGURATION_INCOMPLETE not in output:
        return {}
    broken: Dict[str, str] = {}
    for error in _CMAKE_ERROR.split(output)[1:]:
        place, message, missing = (p.search(error) for p in (_CMAKE_PLACE, _CMAKE_REASON, _MISSING_CONFIG))
        if missing:
            reason = f"needs {missing.group(1)}, which is not installed"
        else:
            reason = message.group(1) if message else "cannot be configured"
        for name in _packages_at(workspace, place.group(1)) - set(workspace.missing) if place else ():
            broken.setdefault(name, reason)
    return broken


def _broken_sources(workspace: Workspace, output: str) -> Dict[str, str]:
    broken: Dict[str, str] = {}
    for file, error in _BROKEN_SOURCE.findall(output):
        for name in _packages_at(workspace, file):
            broken.setdefault(name, f"{Path(file).name}: {error}")
    for target, error in _BROKEN_LINK.findall(output):
        broken.setdefault(target, error)
    return broken


def _packages_at(workspace: Workspace, path: str) -> Set[str]:
    """The package that contains a path; CMake prints it relative to src, compilers print it absolute."""
    place = Path(path) if path.startswith("/") else workspace.folder / "src" / path
    return {name for name, folder in workspace.packages.items() if place == folder or folder in place.parents}
