"""Dry run of a shell script: bash runs it with stubs that record the arguments of every call.

This reveals the paths that a script composes from variables, without reimplementing the shell.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Dict, List, Sequence

# Programs that scripts use to compose paths and that change nothing: they are executed.
SIDE_EFFECT_FREE_PROGRAMS = (
    "awk basename bash cat cut date dirname env expr find grep head hostname id ls nproc readlink realpath "
    "sed seq sh sort tail tr uname wc which whoami"
).split()
# Time limit, wall time: some scripts loop forever.
DRY_RUN_SECONDS = 5.0
# Sourced by bash before the script: commands are only recorded; cd and source tolerate missing files.
RECORDING_PRELUDE = """
_record() { printf '%s\\n' "$@"; env; } >> "$RUN_PROJECT_RECORDING"
command_not_found_handle() { _record "${@:2}"; }
cd() { _record "${@: -1}"; builtin cd "$@" 2> /dev/null || true; }
source() { _record "$1"; case "$1" in *setup.*) ;; *) [ ! -f "$1" ] || builtin source "$@" ;; esac; }
.() { source "$@"; }
for _name in kill wait read; do eval "$_name() { :; }"; done
"""


def recorded_calls(script: Path, folder: Path, arguments: Sequence[str]) -> str:
    """Record the calls of a shell script.

    Args:
        script: The script; anything but a shell script is not run.
        folder: Working folder of the script.
        arguments: Its command line arguments.

    Returns:
        Arguments of all calls and the environment variables at each, one a line.
    """
    if not _is_shell(script):
        return ""
    with tempfile.TemporaryDirectory(prefix="dry-run-") as made:
        here = Path(made)
        (here / "recording.bash").write_text(RECORDING_PRELUDE)
        programs = here / "bin"
        programs.mkdir()
        for name in SIDE_EFFECT_FREE_PROGRAMS:
            found = shutil.which(name)
            if found:
                (programs / name).symlink_to(found)
        variables = {
            "BASH_ENV": str(here / "recording.bash"),
            "RUN_PROJECT_RECORDING": str(here / "recording"),
            "PATH": str(programs),
            **{name: os.environ[name] for name in ("HOME", "USER") if name in os.environ},
        }
        _run([str(shutil.which("bash")), str(script), *arguments], folder, variables)
        recording = here / "recording"
        lines = recording.read_text(errors="replace").splitlines() if recording.exists() else []
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
