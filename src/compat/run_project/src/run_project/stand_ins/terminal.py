"""Stand-in for terminal emulators: each window is a process with a log file."""

import contextlib
import os
import subprocess
from pathlib import Path
from typing import Iterator, List

from run_project.stand_ins.windows import commands_of, returns_at_once, title_of

LOG_FOLDER_VARIABLE = "RUN_PROJECT_LOGS"
# Input for windows: lines of WINDOW=TEXT.
INPUT_VARIABLE = "RUN_PROJECT_TYPED"
# Other logs in the same folder.
NOT_WINDOWS = ("build", "master", "record", "rosout", "script")


def main(terminal: str, arguments: List[str]) -> None:
    """Open the windows of a terminal's command line, and wait for them if the terminal would."""
    folder = Path(os.environ[LOG_FOLDER_VARIABLE])
    windows = [open_window(command, folder) for command in commands_of(terminal, arguments)]
    if not returns_at_once(terminal):
        with contextlib.suppress(KeyboardInterrupt):
            for window in windows:
                window.wait()


def open_window(command: List[str], folder: Path) -> subprocess.Popen:
    """Start the command of a window in a new session; its output goes to ``folder``/TITLE.log."""
    title = title_of(command)
    with _new_file(folder, title) as log, _keyboard(title) as keys:
        log.write((" ".join(command) + "\n").encode("utf-8", "surrogateescape"))
        log.flush()
        return subprocess.Popen(
            command, stdin=keys, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
        )


@contextlib.contextmanager
def _keyboard(title: str) -> Iterator[int]:
    """A pipe with the input for a window; it stays open after the last line, as a keyboard does."""
    reading, writing = os.pipe()
    both = os.open(
        f"/proc/self/fd/{reading}", os.O_RDWR
    )  # opened for writing as well, so that readers get no end of file
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
    """Finds the logs of new windows in a folder."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._known = set(NOT_WINDOWS)

    def opened(self) -> List[str]:
        """Names of the windows opened since the last call."""
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
