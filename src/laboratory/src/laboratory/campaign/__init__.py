"""Campaigns: many scenario runs, distributed over the cores of one or several machines by Dask."""

from laboratory.campaign.campaign import Campaign, ScenarioRun
from laboratory.campaign.workers import Workers

__all__ = ["Campaign", "ScenarioRun", "Workers"]
