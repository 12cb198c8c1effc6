"""Files that a plugin consists of."""

import ast
import importlib.util
import sysconfig
from importlib import metadata
from pathlib import Path
from typing import Any, Collection, Dict, Iterable, Iterator, List, Optional, Set, Tuple

# Weights, tables and compiled code beside a module.
DATA_SUFFIXES = (
    ".csv", ".h5", ".json", ".npy", ".npz", ".onnx", ".pickle", ".pkl", ".pt", ".pth", ".safetensors", ".so",
    ".yaml",
)  # fmt: skip
# First parts of the groups of entry points.
_EXTENSIBLE = ("move_base_lite", "amcl_lite", "slam_lite", "sim_bridge", "laboratory", "home_service")
_INSTALLED = ("site-packages", "dist-packages")


def source_files(names: Iterable[str], known: Collection[str] = ()) -> Tuple[Path, ...]:
    """Return the existing files on which the behavior of plugins depends.

    These are their modules, the modules that these import, and the data files beside each of them. Modules of
    Python and of other installed packages are left out.

    Args:
        names: Names of plugins: dotted names or entry points; others are ignored.
        known: Packages that are left out.
    """
    pending = [module for name in names for module in _modules_of(name)]
    plugins = {module.split(".")[0] for module in pending}
    met: Set[str] = set()
    files: Dict[Path, None] = {}
    while pending:
        module = pending.pop(0)
        package = module.split(".")[0]
        if module in met or package in known:
            continue
        met.add(module)
        path = _file_of(module)
        if path is not None and (package in plugins or not _is_installed(path)):
            files[path] = None
            files.update(dict.fromkeys(_data_beside(path)))
            pending += _imports(path, module)
    return tuple(files)


def _modules_of(name: str) -> List[str]:
    """Return the module of a dotted name, or those of the entry points of a name."""
    module = name.rpartition("/")[0]
    if module:
        return [module] if "." in module else []
    found: Any = metadata.entry_points()
    # Before Python 3.10 it is a dictionary by group.
    by_group = found if isinstance(found, dict) else {each: found.select(group=each) for each in found.groups}
    ours = [
        each for group, entries in by_group.items() if group.split(".")[0] in _EXTENSIBLE for each in entries
    ]
    return [each.value.split(":")[0] for each in ours if each.name == name]


def _file_of(module: str) -> Optional[Path]:
    try:
        spec = importlib.util.find_spec(module)
    except (ImportError, ValueError, AttributeError):  # no such package, or an invalid name
        return None
    path = None if spec is None or spec.origin is None else Path(spec.origin)
    return path if path is not None and path.is_file() else None


def _is_installed(path: Path) -> bool:
    standard = {Path(sysconfig.get_path(name)) for name in ("stdlib", "platstdlib")}
    return bool(set(_INSTALLED) & set(path.parts)) or bool(standard & set(path.parents))


def _data_beside(path: Path) -> List[Path]:
    return sorted(each for each in path.parent.iterdir() if each.suffix in DATA_SUFFIXES and each.is_file())


def _imports(path: Path, module: str) -> Iterator[str]:
    """Yield the names of modules, and of what may be a module, that a file imports."""
    if path.suffix != ".py":
        return
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError):
        return
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            outer = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            source = ".".join([*outer, *filter(None, [node.module])])
            names = [source, *(f"{source}.{alias.name}" for alias in node.names)]
        else:
            continue
        for name in names:
            parts = name.split(".")
            yield from (".".join(parts[:count]) for count in range(1, len(parts) + 1))
