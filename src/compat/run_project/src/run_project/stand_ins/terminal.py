"""The terminal emulator without a screen: each window is a process of its own, with a log of its own."""

import contextlib
import os
import subprocess
from pathlib import Path
from typing import Iterator, List

from run_project.stand_ins.windows import commands_of, returns_at_once, title_of

LOG_FOLDER_VARIABLE = "RUN_PROJECT_LOGS"
# What is typed into windows: lines of WINDOW=TEXT.
INPUT_VARIABLE = "RUN_PROJECT_TYPED"
# Logs that lie beside those of the windows.
NOT_WINDOWS = ("build", "master", "record", "script")


def main(terminal: str, arguments: List[str]) -> None:
    """Opens the windows that were asked for, and stays as long as the terminal would."""
    folder = Path(os.environ[LOG_FOLDER_VARIABLE])
    windows = [open_window(command, folder) for command in commands_of(terminal, arguments)]
    if not returns_at_once(terminal):
        with contextlib.suppress(KeyboardInterrupt):
            for window in windows:
                window.wait()


def open_window(command: List[str], folder: Path) -> subprocess.Popen:
    """Starts a command that outlives whoever asked for it. Its output goes to a file named after it."""
    title = title_of(command)
    with _new_file(folder, title) as log, _keyboard(title) as keys:
        log.write((" ".join(command) + "\n").encode("utf-8", "surrogateescape"))
        log.flush()
        return subprocess.Popen(
            command, stdin=keys, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
        )


@contextlib.contextmanager
def _keyboard(title: str) -> Iterator[int]:
    """What is typed into a window; then nothing more comes, but it does not end, as no keyboard does."""
    reading, writing = os.pipe()
    both = os.open(f"/proc/self/fd/{reading}", os.O_RDWR)  # who reads from this holds it open for writing
    os.close(reading)
    os.close(writing)
    for line in os.environ.get(INPUT_VARIABLE, "").splitlines():
        window, _, text = line.partition("=")
        if window in (title, title.partition("-")[2]):
            os.write(both, text.encode() + b"\n")
    try:
        yield both
    finally:
        os.close(both)


class WindowLogs:
    """The logs of the windows in a folder, as they come."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._known = set(NOT_WINDOWS)

    def opened(self) -> List[str]:
        """The names of the windows that have been opened since the last call."""
        new = sorted({log.stem for log in self._folder.glob("*.log")} - self._known)
        self._known.update(new)
        return new


def _new_file(folder: Path, title: str):
    number = 1
    while True:
        path = folder / f"{title}{f'-{number}' if number > 1 else ''}.log"
        try:
            return path.open("xb")
        except FileExistsError:
            number += 1
