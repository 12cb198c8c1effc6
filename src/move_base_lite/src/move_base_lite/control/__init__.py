"""Local control: a velocity that follows the plan without touching anything."""

from move_base_lite.control.controller import Control, Controller
from move_base_lite.control.settings import DwaSettings

__all__ = ["Control", "Controller", "DwaSettings"]
