"""Searches over scenarios: parameter tuning and falsification."""
