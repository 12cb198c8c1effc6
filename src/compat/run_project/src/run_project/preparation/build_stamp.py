"""Whether a project has to be built: not if nothing has changed since its last complete build."""

import contextlib
import hashlib
import os
from pathlib import Path
from typing import Iterator, Sequence

from planar.files.writing import write_atomically

# Changes with each package that is installed or upgraded.
SYSTEM_PACKAGES = Path("/var/lib/dpkg/status")


class BuildStamp:
    """Stamp of a complete build.

    Args:
        file: File of the stamp.
        tree: The copied project, before anything is completed or converted; build results are links in it.
        choices: What else the build depends on, as texts.
    """

    def __init__(self, file: Path, tree: Path, choices: Sequence[str]):
        self._file = file
        prefixes = os.environ.get("CMAKE_PREFIX_PATH", "").split(":")
        parts = [*choices, *map(os.path.realpath, prefixes), _state_of(SYSTEM_PACKAGES), *_states_in(tree)]
        self._digest = hashlib.sha256("\n".join(parts).encode("utf-8", "surrogateescape")).hexdigest()

    @property
    def is_current(self) -> bool:
        """Whether the last build was complete, and of the same sources."""
        try:
            return self._file.read_text() == self._digest
        except OSError:
            return False

    def remove(self) -> None:
        """Remove the stamp: a build begins."""
        self._file.unlink(missing_ok=True)

    def write(self) -> None:
        """Write the stamp: the build is complete."""
        write_atomically(self._file, self._digest.encode())


def _states_in(tree: Path) -> Iterator[str]:
    for folder, folders, files in os.walk(tree):
        folders.sort()
        for name in sorted({*files, *(name for name in folders if Path(folder, name).is_symlink())}):
            yield _state_of(Path(folder, name))


def _state_of(path: Path) -> str:
    """Path, size and time of a file, or the target of a link; an empty file may be made again at any time."""
    with contextlib.suppress(OSError):
        if path.is_symlink():
            return f"{path} -> {os.readlink(path)}"
        found = path.stat()
        changed = found.st_mtime_ns if found.st_size else 0
        return f"{path} {found.st_size} {changed} {found.st_mode}"
    return str(path)
