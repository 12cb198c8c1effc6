"""Plugins of the tests."""
