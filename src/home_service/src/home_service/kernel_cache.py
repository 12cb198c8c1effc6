"""Discard compiled kernels whose sources have changed: numba checks only the file that defines a kernel.

A cached kernel contains the machine code of the kernels it calls, and its index the names of the classes in
its arguments. Both may be defined in other files, so each cache is keyed by the sources of all of them and by
the versions of numba and numpy.

python3 -m home_service.kernel_cache WORKSPACE
"""

import ast
import hashlib
import json
import sys
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Set, Tuple

from planar.files.writing import write_atomically

DIGESTS = Path("build/kernels.json")
LIBRARIES = ("numba", "numpy", "llvmlite")


class SourceTree:
    """Resolves imports between the modules of a workspace.

    Args:
        workspace: Folder that contains ``src/<package>/src``.
    """

    def __init__(self, workspace: Path):
        self._roots = sorted(path for path in workspace.glob("src/**/src") if path.is_dir())
        # Most kernel modules import the same modules.
        self._imports = lru_cache(maxsize=None)(imports)
        self._path = lru_cache(maxsize=None)(self._locate)

    def kernel_modules(self) -> Iterator[Path]:
        """Yield the modules that use numba."""
        for root in self._roots:
            yield from (path for path in sorted(root.glob("**/*.py")) if b"numba" in path.read_bytes())

    def sources(self, module: Path) -> Set[Path]:
        """Return a module and all modules that define names it imports, directly or indirectly."""
        found: Set[Path] = set()
        pending = [module]
        while pending:
            path = pending.pop()
            if path not in found:
                found.add(path)
                pending += [
                    source for name, alias in self._imports(path) if (source := self._find(name, alias))
                ]
        return found

    def _find(self, module: str, name: str) -> Optional[Path]:
        """Return the file that defines a name, followed through the packages that re-export it."""
        path = self._path(f"{module}.{name}" if name else module) or self._path(module)
        if path is None or path.name != "__init__.py" or not name:
            return path
        for source, imported in self._imports(path):
            if imported == name and source != module:
                return self._find(source, name)
        return path

    def _locate(self, module: str) -> Optional[Path]:
        parts = module.split(".")
        for root in self._roots:
            for path in (root.joinpath(*parts).with_suffix(".py"), root.joinpath(*parts, "__init__.py")):
                if path.is_file():
                    return path
        return None


def imports(path: Path) -> List[Tuple[str, str]]:
    """List (module, name) of each name that a file imports; the name of a module import is empty."""
    found: List[Tuple[str, str]] = []
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found += ((node.module, alias.name) for alias in node.names)
        elif isinstance(node, ast.Import):
            found += ((alias.name, "") for alias in node.names)
    return found


def kernel_digests(workspace: Path) -> Dict[str, str]:
    """Compute the digest of each kernel module from all its sources and the versions of the libraries.

    Args:
        workspace: Root of the workspace.

    Returns:
        Digests by the path of the module relative to the workspace.
    """
    tree = SourceTree(workspace)
    libraries = " ".join(f"{name} {version(name)}" for name in LIBRARIES)
    digests = {}
    for module in tree.kernel_modules():
        digest = hashlib.sha256(libraries.encode())
        for source in sorted(tree.sources(module)):
            digest.update(hashlib.sha256(source.read_bytes()).digest())
        digests[str(module.relative_to(workspace))] = digest.hexdigest()
    return digests


def discard_stale_kernels(workspace: Path) -> int:
    """Remove the compiled kernels of all modules whose sources have changed since the last call.

    Args:
        workspace: Root of the workspace; the digests are kept in its build folder.

    Returns:
        Number of removed files.
    """
    record = workspace / DIGESTS
    try:
        known = json.loads(record.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        known = {}
    current = kernel_digests(workspace)
    removed = 0
    for name, digest in current.items():
        if known.get(name) != digest:
            module = workspace / name
            for compiled in (module.parent / "__pycache__").glob(f"{module.stem}.*.nb[ic]"):
                compiled.unlink()
                removed += 1
    record.parent.mkdir(exist_ok=True)
    write_atomically(record, json.dumps(current, indent=1).encode())
    return removed


if __name__ == "__main__":
    print(f"{discard_stale_kernels(Path(sys.argv[1]).resolve())} files of stale kernels removed")
