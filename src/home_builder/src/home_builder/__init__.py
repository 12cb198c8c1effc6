"""Homes from floor plans, maps and drawings: a plan, its checks, and the folder that is built from it."""

from home_builder.folder import build_home
from home_builder.plan.checks import Problem, problems_of
from home_builder.plan.file import load_plan, parse_plan, plan_text
from home_builder.plan.model import FurniturePiece, HomePlan, Opening, Place, Room, Wall, Zone

__all__ = [
    "FurniturePiece",
    "Opening",
    "Place",
    "HomePlan",
    "Problem",
    "Room",
    "Wall",
    "Zone",
    "build_home",
    "load_plan",
    "parse_plan",
    "plan_text",
    "problems_of",
]
