"""A file system of its own for one run, in which folders appear where the project's author had them.

Run as a program by ``unshare``, in a mount namespace of its own: builds a root in which everything is where
it is, and the mounts besides; then becomes the command. Nothing outside of it changes, and it ends with the
last process in it.
"""

import ctypes
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Dict, List, Mapping

from planar import PlanarError

MS_BIND, MS_REC = 4096, 16384


class MountError(PlanarError):
    """The absolute paths that the project names cannot be provided on this system."""


def private_mount_command(mounts: Mapping[Path, Path], root: Path) -> List[str]:
    """What to put before a command for it to run where ``mounts`` (target: source) are seen.

    ``root`` is an empty folder. Raises PlaceError if this system allows no private mounts.
    """
    if not mounts:
        return []
    unshare = ["unshare", "--mount", "--propagation", "private"]
    if os.geteuid() != 0:
        unshare += ["--user", "--map-root-user"]
    try:
        trial = subprocess.run([*unshare, "true"], capture_output=True, text=True)
        refusal = trial.stderr.strip() if trial.returncode else ""
    except FileNotFoundError:
        refusal = "there is no command unshare"
    if refusal:
        targets = ", ".join(map(str, mounts))
        raise MountError(
            f"the project's files name {targets}, and this system does not let them be provided ({refusal}): "
            "run as root, allow user namespaces, or put the project there"
        )
    plan = json.dumps([[str(target), str(source)] for target, source in mounts.items()])
    return [*unshare, sys.executable, "-m", "run_project.preparation.private_root", str(root), plan]


def bind_tree(host: Path, new: Path, mounts: Mapping[Path, Path]) -> None:
    """Fills the empty folder ``new`` with what is in ``host``, and with the mounts at and below ``host``."""
    inner = {target: source for target, source in mounts.items() if host in target.parents}
    above = {host / target.relative_to(host).parts[0] for target in inner}
    shown: Dict[Path, Path] = {}
    for folder in (host, mounts.get(host)):
        if folder is not None and folder.is_dir():
            shown.update({host / entry.name: folder / entry.name for entry in os.scandir(folder)})
    for path in sorted({*shown, *above}):
        there = new / path.name
        if path not in above:
            _bind(shown[path], there)
        elif path in mounts and not path.is_dir() and not any(path in target.parents for target in inner):
            _bind(mounts[path], there)
        else:
            there.mkdir()
            bind_tree(path, there, mounts)


def _bind(path: Path, there: Path) -> None:
    if path.is_symlink():
        there.symlink_to(os.readlink(path))
        return
    if path.is_dir():
        there.mkdir()
    else:
        there.touch()
    _mount(str(path), str(there), None, MS_BIND | MS_REC)


def _mount(source: str, target: str, kind, flags: int) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mount(source.encode(), target.encode(), kind and kind.encode(), flags, None) != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number), target)


def main() -> None:
    root, plan, *command = sys.argv[1:]
    folder = Path.cwd()
    _mount("tmpfs", root, "tmpfs", 0)
    bind_tree(Path("/"), Path(root), {Path(target): Path(source) for target, source in json.loads(plan)})
    os.chroot(root)
    os.chdir(folder)
    os.execvp(command[0], command)


if __name__ == "__main__":
    main()
