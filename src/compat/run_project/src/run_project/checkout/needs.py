"""What a script needs that is not there, found before the build: packages and environment variables."""

import re
from typing import Callable, Container, List

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
