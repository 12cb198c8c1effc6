"""Scenario files, campaigns of thousands of runs on all cores, their statistics and an HTML report."""
