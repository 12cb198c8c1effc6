"""Tells from what a run left behind whether the project did what it set out to do."""
