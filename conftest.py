"""Let pytest import all packages from the source tree, and the shared helpers of tests."""

import sys
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parent
# Folders of tests/ with unit tests; scripts in the others are run by .test files.
UNIT_FOLDERS = ("runner", "repository", "fuzz", "conformance")
sys.path[:0] = [str(path) for path in sorted(ROOT.glob("src/**/src")) if path.is_dir()]
sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("runner", "repository", "conformance", "shared")]
sys.path[1:1] = [str(path) for path in sorted(ROOT.glob("src/*/test")) if path.is_dir()]
pytest_plugins = ["rostest_plugin"]
# Only the development set-up installs Hypothesis.
collect_ignore_glob = [] if find_spec("hypothesis") else ["src/*/test/test_*_histories.py"]


def pytest_addoption(parser):
    parser.addoption(
        "--only", action="append", metavar="NAME", help="only files whose paths contain NAME, or another one"
    )


def pytest_ignore_collect(collection_path, config):
    """Unlike a named file, a selected one may still be ignored by the conftest.py beside it."""
    place = collection_path.relative_to(ROOT).parts
    if collection_path.suffix == ".py" and place[0] == "tests" and place[1] not in UNIT_FOLDERS:
        return True  # a script of a .test file
    names = config.getoption("only")
    if not names or collection_path.is_dir():
        return None
    path = collection_path.relative_to(ROOT).as_posix()
    return None if any(name in path for name in names) else True
