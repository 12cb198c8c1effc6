"""What a project needs, found before the build: packages, environment variables, nodes of navigation."""

import re
from pathlib import PurePath
from typing import Callable, Container, Iterable, List, Mapping, NamedTuple, Sequence, Set

from run_project.stand_ins import is_of_workspace

_STARTED = re.compile(r"\b(?:roslaunch|rosrun|roscd)\s+(?:-{1,2}[\w-]+\s+)*([a-zA-Z]\w*)(?=[\s\"']|$)")
_COMMENT = re.compile(r"(?:^|(?<=\s))#.*", re.MULTILINE)
_SINGLE_QUOTED = re.compile(r"'[^']*'")
# With a default or an alternative, as in ${NAME:-value}, a variable may be unset.
_USED = re.compile(r"\$(?:([A-Za-z_]\w*)|\{([A-Za-z_]\w*)\})")
_ASSIGNED = re.compile(r"(?:^|[\s;&(])([A-Za-z_]\w*)(?:\[[^]]*\])?\+?=", re.MULTILINE)
_READ = re.compile(r"\b(?:read|for|select|mapfile|readarray|getopts)\s+([^;&|\n]*)")
_WORD = re.compile(r"[A-Za-z_]\w*")
# Set by bash itself.
_OF_BASH = frozenset(
    "BASH BASHPID BASH_SOURCE BASH_VERSION DIRSTACK EUID FUNCNAME GROUPS HOSTNAME HOSTTYPE IFS LINENO "
    "MACHTYPE OLDPWD OPTARG OPTIND OSTYPE PIPESTATUS PPID PWD RANDOM REPLY SECONDS SHELL SHLVL UID".split()
)
_NODE = re.compile(r"<node\b[^>]*>")
_ATTRIBUTE = re.compile(r"\b(pkg|name)\s*=\s*[\"']([^\"']*)")
# Packages whose nodes advance in lock-step, and what starts both in launch files of public packages.
_NAVIGATION = ("amcl", "move_base")
_STARTS_NAVIGATION = re.compile(r"turtlebot3?_navigation|\bamcl_demo")


class DefaultFile(NamedTuple):
    """A file that a launch file of turtlebot_gazebo takes from its environment.

    Attributes:
        launch_file: Name of the launch file.
        argument: Its argument.
        variable: Variable that is the argument's default.
    """

    launch_file: str
    argument: str
    variable: str


_DEFAULT_FILES = (
    DefaultFile("turtlebot_world.launch", "world_file", "TURTLEBOT_GAZEBO_WORLD_FILE"),
    DefaultFile("amcl_demo.launch", "map_file", "TURTLEBOT_GAZEBO_MAP_FILE"),
)


def missing_packages(script: str, is_there: Callable[[str], bool]) -> List[str]:
    """Packages from which a script starts something, and that are not there.

    Args:
        script: Text of the script.
        is_there: Whether a package is in the checkout or installed.
    """
    named = _STARTED.findall(_COMMENT.sub("", script))
    return sorted({name for name in named if not name.endswith(("launch", "xml")) and not is_there(name)})


def unset_variables(script: str, environment: Container[str]) -> List[str]:
    """Variables that a script uses, does not assign, and that its environment lacks.

    Args:
        script: Text of the script.
        environment: Names of the variables that are set where it starts.
    """
    text = _COMMENT.sub("", script)
    assigned = {*_OF_BASH, *_ASSIGNED.findall(text)}
    assigned.update(*(_WORD.findall(words) for words in _READ.findall(text)))
    used = {first or second for first, second in _USED.findall(_SINGLE_QUOTED.sub("", text))}
    return sorted(name for name in used - assigned if name not in environment)


def files_left_to_environment(
    script: str,
    own: Mapping[str, Sequence[str]],
    launch_files: Iterable[str],
    environment: Mapping[str, str],
) -> List[str]:
    """What the author's environment may have named: worlds and maps instead of which the defaults are used.

    Args:
        script: Text of the script.
        own: Worlds and maps of the project, by the arguments ``world_file`` and ``map_file``.
        launch_files: Launch files of the project: its copies may have other defaults.
        environment: Variables where it starts; this workspace sets them to files of its package.

    Returns:
        Sentences, with the variable to set.
    """
    text = _COMMENT.sub("", script)
    with_own_default = {PurePath(file).name for file in launch_files}
    found = []
    for launch_file, argument, variable in _DEFAULT_FILES:
        starts = re.findall(rf"turtlebot_gazebo\s+{re.escape(launch_file)}\b([^;&|\n]*)", text)
        is_left_out = any(f"{argument}:=" not in arguments for arguments in starts)
        is_from_user = variable in environment and not is_of_workspace(environment[variable])
        is_set = is_from_user or variable in _ASSIGNED.findall(text)
        if own[argument] and is_left_out and not is_set and launch_file not in with_own_default:
            found.append(
                f"{launch_file} is started without {argument}, so with the default, but the checkout "
                f"has {', '.join(own[argument])}: if that is meant, set {variable} to its path"
            )
    return found


def navigation_nodes(texts: Iterable[str]) -> List[str]:
    """Names of the nodes of localization and navigation that a project starts.

    Args:
        texts: Its scripts and the launch files in its packages.
    """
    found: Set[str] = set()
    for text in texts:
        tags = (dict(_ATTRIBUTE.findall(tag)) for tag in _NODE.findall(text))
        found.update(tag["name"] for tag in tags if tag.get("pkg") in _NAVIGATION and "name" in tag)
        if _STARTS_NAVIGATION.search(_COMMENT.sub("", text)):
            found.update(_NAVIGATION)
    return sorted(name for name in found if "$(" not in name)
