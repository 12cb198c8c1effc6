"""Lets pytest import every package from the source tree, built or not, and what tests share."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
sys.path[:0] = [str(path) for path in sorted(ROOT.glob("src/**/src")) if path.is_dir()]
sys.path[:0] = [str(ROOT / "tests/runner"), str(ROOT / "tests/repository")]
sys.path[1:1] = [str(path) for path in sorted(ROOT.glob("src/*/test")) if path.is_dir()]
