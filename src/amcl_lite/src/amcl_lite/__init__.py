"""Adaptive Monte-Carlo localization in a known map, without ROS; the node is in ``amcl_lite.ros.node``."""

from amcl_lite.config import LocalizerSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.filter.particles import ParticleSet
from amcl_lite.localizer import Estimate, Localizer

__all__ = ["Estimate", "LocalizationError", "Localizer", "LocalizerSettings", "ParticleSet"]
