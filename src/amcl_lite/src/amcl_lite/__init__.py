"""Adaptive Monte-Carlo localization in a known map, without ROS; the node is in ``amcl_lite.ros.node``."""

from amcl_lite.config import LocalizerSettings
from amcl_lite.localizer import Estimate, Localizer
from amcl_lite.particles import LocalizationError, ParticleSet

__all__ = ["Estimate", "LocalizationError", "Localizer", "LocalizerSettings", "ParticleSet"]
