"""What of a checkout is run: a script, a launch file, or a command as the author's README has it."""

import os
import re
import shlex
from pathlib import Path
from typing import List, Optional

from run_project.checkout.layout import Checkout, ProjectError
from run_project.checkout.vendored import is_vendored

HOME_SERVICE = "home_service"
ROS_COMMANDS = ("roslaunch", "rosrun")
MAX_PROPOSALS = 8
_README_COMMAND = re.compile(
    r"^[\s$>`]*((?:(?:roslaunch|rosrun|bash|sh)\s+[\w./~-]+|\./[\w./-]+\.(?:sh|bash))[^`#\n]*)", re.MULTILINE
)


def choose_script(checkout: Checkout, wanted: Optional[str], work: Path) -> Path:
    """Select what to run; for a launch file or a command, a script is written.

    Args:
        checkout: The project.
        wanted: Path relative to the checkout, or name with or without ``.sh``; a launch file likewise; a
            command that starts with ``roslaunch`` or ``rosrun``; None for home_service.sh.
        work: Folder for a script that is written, named as what it starts.

    Returns:
        Path of the script relative to the checkout, or in ``work``.

    Raises:
        ProjectError: There is none; the text has what the checkout offers.
    """
    found = _existing_script(checkout, wanted)
    if found is not None:
        return found
    command = None if wanted is None else _ros_command(checkout, wanted)
    if command is None:
        name = wanted or f"{HOME_SERVICE}.sh"
        raise ProjectError(f"{checkout.root}: no script {name} in this checkout; {_proposals(checkout)}")
    script = work / (re.sub(r"[^\w.-]+", "_", wanted or "") + ".sh")
    script.write_text(f"#!/bin/sh\nexec {command}\n")
    script.chmod(0o755)
    return script


def is_home_service_script(script: str) -> bool:
    """Whether a script, by its name, drives the robot; other scripts may only show a marker."""
    return _letters_only(HOME_SERVICE) in _letters_only(Path(script).stem)


def _existing_script(checkout: Checkout, wanted: Optional[str]) -> Optional[Path]:
    scripts = checkout.scripts()
    if wanted is None:
        chosen = [script for script in scripts if script.stem == HOME_SERVICE] or [
            script for script in scripts if is_home_service_script(str(script))
        ]
    else:
        others = [Path(file) for file in checkout.files if not file.endswith(".launch")]
        chosen = [file for file in others if str(file) == os.path.normpath(wanted)] or [
            file for file in others if file.name in (wanted, f"{wanted}.sh")
        ]
    return _nearest(chosen)


def _ros_command(checkout: Checkout, wanted: str) -> Optional[str]:
    """The command that starts a launch file, or ``wanted`` itself if it is one."""
    words = wanted.split()
    if words[:1] and words[0] in ROS_COMMANDS:
        return shlex.join(shlex.split(wanted))
    launches = checkout.launch_files()
    file = _nearest([file for file in launches if str(file) == os.path.normpath(wanted)]) or _nearest(
        [file for file in launches if file.name in (wanted, f"{wanted}.launch")]
    )
    if file is None:
        return None
    package = checkout.package_of(file)
    return None if package is None else f"roslaunch {package} {shlex.quote(file.name)}"


def _proposals(checkout: Checkout) -> str:
    scripts = [str(script) for script in checkout.scripts()]
    launches = [
        str(file) for file in checkout.launch_files() if not is_vendored(checkout.package_of(file) or "")
    ]
    commands = [repr(command) for command in readme_commands(checkout)]
    offers = [
        f"{what} ({', '.join(names[:MAX_PROPOSALS])}{', ...' if len(names) > MAX_PROPOSALS else ''})"
        for what, names in (
            ("one of its scripts", scripts),
            ("a launch file", launches),
            ("a command as its README has it", commands),
        )
        if names
    ]
    if not offers:
        return "it has neither a script nor a launch file: name a command that starts with rosrun"
    return f"name {' or '.join(offers)} after the path"


def readme_commands(checkout: Checkout) -> List[str]:
    """The command lines in the README files of a checkout that start something, in order."""
    found = []
    for file in checkout.files:
        if len(Path(file).parts) <= 3 and Path(file).stem.lower() == "readme":
            text = (checkout.root / file).read_text(errors="replace")
            found += [command.strip() for command in _README_COMMAND.findall(text)]
    return list(dict.fromkeys(found))


def _nearest(files: List[Path]) -> Optional[Path]:
    """The file that is least deep in the checkout."""
    return min(files, key=lambda file: (len(file.parts), str(file))) if files else None


def _letters_only(text: str) -> str:
    return "".join(letter for letter in text.lower() if letter.isalpha())
