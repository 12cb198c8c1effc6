"""Lets pytest import every package from the source tree, built or not, and what tests share."""

import sys
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parent
sys.path[:0] = [str(path) for path in sorted(ROOT.glob("src/**/src")) if path.is_dir()]
sys.path[:0] = [str(ROOT / "tests/runner"), str(ROOT / "tests/repository")]
sys.path[1:1] = [str(path) for path in sorted(ROOT.glob("src/*/test")) if path.is_dir()]
# Hypothesis, for tests of histories, comes with the set-up for development alone.
collect_ignore_glob = [] if find_spec("hypothesis") else ["src/*/test/test_*_histories.py"]
