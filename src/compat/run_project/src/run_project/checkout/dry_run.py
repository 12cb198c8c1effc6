"""What a script tells the programs it calls: learned by running it once where all of them only listen.

So paths are known that a script puts together from its variables, whatever the shell can do.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Dict, List, Sequence

# Programs that scripts put paths together with, and that change nothing.
SIDE_EFFECT_FREE_PROGRAMS = (
    "awk basename bash cat cut date dirname env expr find grep head hostname id ls nproc readlink realpath "
    "sed seq sh sort tail tr uname wc which whoami"
).split()
# Seconds: some scripts loop for ever.
DRY_RUN_SECONDS = 5.0
# Read by bash before the script: what it calls is written down, what it goes to or reads need not be there.
RECORDING_PRELUDE = """
_told() { printf '%s\\n' "$@"; env; } >> "$RUN_PROJECT_TOLD"
command_not_found_handle() { _told "${@:2}"; }
cd() { _told "${@: -1}"; builtin cd "$@" 2> /dev/null || true; }
source() { _told "$1"; case "$1" in *setup.*) ;; *) [ ! -f "$1" ] || builtin source "$@" ;; esac; }
.() { source "$@"; }
for _name in kill wait read; do eval "$_name() { :; }"; done
"""


def recorded_calls(script: Path, folder: Path, arguments: Sequence[str]) -> str:
    """What the shell script says when it is started in ``folder``: words and variables, one a line."""
    if not _is_shell(script):
        return ""
    with tempfile.TemporaryDirectory(prefix="listening-") as made:
        here = Path(made)
        (here / "listening.bash").write_text(RECORDING_PRELUDE)
        programs = here / "bin"
        programs.mkdir()
        for name in SIDE_EFFECT_FREE_PROGRAMS:
            found = shutil.which(name)
            if found:
                (programs / name).symlink_to(found)
        variables = {
            "BASH_ENV": str(here / "listening.bash"),
            "RUN_PROJECT_TOLD": str(here / "told"),
            "PATH": str(programs),
            **{name: os.environ[name] for name in ("HOME", "USER") if name in os.environ},
        }
        _run([str(shutil.which("bash")), str(script), *arguments], folder, variables)
        recorded = here / "told"
        lines = recorded.read_text(errors="replace").splitlines() if recorded.exists() else []
        return "\n".join(line for line in lines if made not in line)


def _is_shell(script: Path) -> bool:
    first = script.read_bytes().split(b"\n", 1)[0]
    return not first.startswith(b"#!") or b"sh" in first


def _run(command: List[str], folder: Path, variables: Dict[str, str]) -> None:
    process = subprocess.Popen(
        command,
        cwd=str(folder),
        env=variables,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(DRY_RUN_SECONDS)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
