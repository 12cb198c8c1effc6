"""Private mount namespace in which folders appear at the paths where the project's author had them.

Run as a program by ``unshare``: binds the host's files and the mounts into a new root, then executes the
command. The host is not changed; the namespace ends with its last process.
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
    """Command prefix that runs a command in a private mount namespace.

    Args:
        mounts: Target path -> source path, absolute; without mounts the prefix is empty.
        root: An empty folder for the new root.

    Raises:
        MountError: This system does not allow private mounts.
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
        refusal = "the command unshare is not installed"
    if refusal:
        targets = ", ".join(map(str, mounts))
        raise MountError(
            f"the project's files refer to {targets}, which cannot be mounted on this system ({refusal}): "
            "run as root, allow user namespaces, or move the project there"
        )
    plan = json.dumps([[str(target), str(source)] for target, source in mounts.items()])
    return [*unshare, sys.executable, "-m", "run_project.preparation.private_root", str(root), plan]


def bind_tree(host: Path, new: Path, mounts: Mapping[Path, Path]) -> None:
    """Bind the entries of ``host``, and the mounts at and below it, into the empty folder ``new``."""
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
