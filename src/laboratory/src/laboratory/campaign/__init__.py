"""Many missions over all cores, or over machines."""

from laboratory.campaign.campaign import Campaign, ScenarioRun
from laboratory.campaign.workers import Workers

__all__ = ["Campaign", "ScenarioRun", "Workers"]
