"""What any plugin has to do, whoever wrote it: ``python3 -m move_base_lite.check NAME``.

Each seam has a module of checks (planar.contract_check), which are given a Plugin.
"""

from move_base_lite.check.kits import KITS

__all__ = ["KITS"]
