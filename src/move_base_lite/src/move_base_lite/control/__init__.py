"""Local control: a velocity that follows the plan without touching anything."""

from move_base_lite.control.controller import Control, Controller, Situation
from move_base_lite.control.exploration import Exploration
from move_base_lite.control.settings import ControllerSettings, DwaSettings, MppiSettings

__all__ = [
    "Control",
    "Controller",
    "ControllerSettings",
    "DwaSettings",
    "Exploration",
    "MppiSettings",
    "Situation",
]
