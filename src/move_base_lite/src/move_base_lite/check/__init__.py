"""What any plugin has to do, whoever wrote it: ``python3 -m move_base_lite.check NAME``.

Each seam has a module of checks: functions of a Plugin whose docstrings say what is asked, and that raise
CheckFailed with what was found instead. The unit tests hold the project's own plugins to the same.
"""

from move_base_lite.check.expectation import CheckFailed
from move_base_lite.check.kits import KITS, Check, Kit

__all__ = ["KITS", "Check", "CheckFailed", "Kit"]
