"""Scenarios as data, thousands of missions over all cores, statistics of them, and a page to look at."""
