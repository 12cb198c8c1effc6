"""Parser for the command lines of terminal emulators."""

import re
import shlex
from pathlib import Path
from typing import Dict, List, Tuple

# Options without a value; every other one that starts with - or + takes a value, unless written with =.
FLAGS: Dict[str, Tuple[str, ...]] = {
    "xterm": tuple(
        "-hold +hold -ls +ls -sb +sb -rv -bc -iconic -maximized -fullscreen -bdc -cm -cr -dc -im -j -mb -nul "
        "-pc -rw -s -samename -si -sk -u8 -ut -vb -wf -l".split()
    ),
    "terminator": tuple(
        "-m --maximise -f --fullscreen -b --borderless -H --hidden -u --no-dbus --new-tab -d --debug".split()
    ),
    "gnome-terminal": tuple(
        "--tab --window --maximize --full-screen --hide-menubar --show-menubar --active "
        "--preserve-environment --disable-factory --wait -q --quiet".split()
    ),
}
ALIASES = {
    "uxterm": "xterm",
    "lxterm": "xterm",
    "x-terminal-emulator": "xterm",
    "mate-terminal": "gnome-terminal",
    "xfce4-terminal": "gnome-terminal",
    "lxterminal": "gnome-terminal",
    "konsole": "xterm",
}

# zsh expands ~ in this place, bash does not.
_HOME_AS_VALUE = re.compile(r"(?<=:=)~(?=/)")
# Commands with one argument that precede the actual command of a window.
PREPARATORY_COMMANDS = ("source", ".", "cd", "export", "sleep")


def commands_of(terminal: str, arguments: List[str]) -> List[List[str]]:
    """Commands of the windows that a terminal opens.

    Args:
        terminal: Name of the terminal emulator.
        arguments: Its command line arguments.

    Returns:
        Argument vector for each window; a command given as one string runs in bash.
    """
    kind = ALIASES.get(terminal, terminal)
    rest = list(arguments)
    commands = []
    while rest:
        word = rest.pop(0)
        name, has_value, value = word.partition("=")
        if _takes_remaining_words(kind, name) and rest:
            commands.append(_command(rest))
            break
        if name in ("-e", "--command"):
            commands.append(_command([value if has_value else rest.pop(0) if rest else ""]))
        elif word[:1] in "-+" and not has_value and word not in FLAGS.get(kind, ()) and rest:
            rest.pop(0)
    return [command for command in commands if command]


def title_of(command: List[str]) -> str:
    """Name for the log of a window by its command, as ``roslaunch-turtlebot_world``."""
    words = [word for part in command for word in _words(part)]
    for at, word in enumerate(words):
        if word in ("roslaunch", "rosrun"):
            named = [Path(other).stem for other in words[at + 1 :] if ":=" not in other]
            return "-".join([word, *named[1:2]] if len(named) > 1 else [word, *named[:1]])
    at = 0
    while words[at : at + 1] and words[at] in PREPARATORY_COMMANDS:
        at += 2
    return Path(words[at]).name if at < len(words) else "window"


def returns_at_once(terminal: str) -> bool:
    """Whether the terminal's command returns before its windows close, because a server owns them."""
    return ALIASES.get(terminal, terminal) == "gnome-terminal"


def _takes_remaining_words(kind: str, option: str) -> bool:
    if kind == "xterm":
        return option == "-e"
    return option in ("-x", "--execute", "--")


def _command(words: List[str]) -> List[str]:
    if len(words) == 1:
        return ["bash", "-c", _HOME_AS_VALUE.sub("$HOME", words[0])] if words[0].strip() else []
    return words


def _words(text: str) -> List[str]:
    try:
        words = shlex.split(text.replace(";", " ; ").replace("&&", " ; "), comments=False)
    except ValueError:
        words = text.split()
    return [word for word in words if word not in ("bash", "-c", ";")]
