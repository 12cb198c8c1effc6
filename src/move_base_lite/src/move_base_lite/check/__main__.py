"""Check whether a plugin keeps its contract: ``python3 -m move_base_lite.check NAME``."""

import sys

from move_base_lite.check import CHECK_SUITES
from planar.extensions.check import run_checks

if __name__ == "__main__":
    sys.exit(run_checks("move_base_lite", CHECK_SUITES))
